// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Recipes and files from unknown senders: with them thalweg connects to nothing and opens no file elsewhere.
#include <array>
#include <atomic>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <sys/inotify.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <support.hpp>

#include "command.hpp"
#include "listening.hpp"

namespace hostile_test {

namespace fs = std::filesystem;

namespace {

/// A server on this machine that counts who comes and turns everyone away.
class Door {
public:
    Door() {
        thread_ = std::thread([this] {
            for (int guest = accept(listening_.descriptor(), nullptr, nullptr); guest >= 0;
                 guest = accept(listening_.descriptor(), nullptr, nullptr)) {
                ++guests_;
                close(guest);
            }
        });
    }
    ~Door() {
        shutdown(listening_.descriptor(), SHUT_RDWR);
        thread_.join();
    }
    Door(Door const&) = delete;
    Door& operator=(Door const&) = delete;

    std::string const& port() const { return listening_.port(); }
    int take_guests() { return guests_.exchange(0); }

private:
    Listening listening_;
    std::atomic<int> guests_{0};
    std::thread thread_;
};

/// Tells what is opened in a folder.
class Eye {
public:
    explicit Eye(fs::path const& folder) : queue_(inotify_init1(IN_NONBLOCK)) {
        if (queue_ < 0 || inotify_add_watch(queue_, folder.c_str(), IN_OPEN | IN_ACCESS) < 0) {
            throw std::runtime_error("no inotify");
        }
    }
    ~Eye() { close(queue_); }
    Eye(Eye const&) = delete;
    Eye& operator=(Eye const&) = delete;

    std::string take_opened() {
        std::string names;
        alignas(inotify_event) std::array<char, 16384> buffer{};
        for (ssize_t count = read(queue_, buffer.data(), buffer.size()); count > 0;
             count = read(queue_, buffer.data(), buffer.size())) {
            for (ssize_t at = 0; at < count;) {
                auto const* const event = reinterpret_cast<inotify_event const*>(buffer.data() + at);
                names += (event->len > 0 ? std::string(event->name) : ".") + " ";
                at += static_cast<ssize_t>(sizeof(inotify_event) + event->len);
            }
        }
        return names;
    }

private:
    int queue_;
};

using Files = std::vector<std::pair<std::string, std::string>>;

struct Trial {
    std::string recipe; ///< @URL@, @PORT@ and @OUT@ stand for the door and the folder elsewhere
    Files files = {};
};

std::string lines(std::string const& path) {
    return "[grid]\ncell = 10\n[network]\nsource = \"lines\"\n[network.lines]\npath = '" + path + "'\n[surface]\n";
}

std::string const valley = "[grid]\nwidth = 64\nheight = 64\n[network]\nprune = 4\n[network.dla]\nparticles = 400\n";

std::string patch(std::string const& source) {
    return valley + "[surface]\n[[patch]]\nat = [500900, 4999000]\nsource = '" + source + "'\n";
}

std::string surface(std::string const& key, std::string const& file) {
    return valley + "[surface]\n" + key + " = '" + file + "'\n";
}

std::string strokes(std::string const& file) {
    return "[grid]\nwidth = 96\nheight = 96\n[network]\nsource = \"tokunaga\"\n[network.tokunaga]\norder = 3\nstrokes "
           "= '" +
           file + "'\n";
}

std::string forest(std::string const& key, std::string const& file) {
    return "[grid]\nwidth = 64\nheight = 64\n[network]\nsource = \"forest\"\nprune = 6\n[network.forest]\n" + key +
           " = '" + file + "'\n";
}

std::string points(std::string const& file) {
    return "[grid]\nwidth = 64\nheight = 64\n[skeleton]\npoints = '" + file + "'\n[surface]\nmethod = \"diffuse\"\n";
}

std::string in_crs(std::string const& crs) {
    return "[grid]\nwidth = 64\nheight = 64\ncrs = '" + crs + "'\n[network]\n[network.dla]\nparticles = 400\n";
}

std::string const projected =
    R"(PROJCS["x",GEOGCS["y",DATUM["z",SPHEROID["c",6378137,298]],PRIMEM["G",0],UNIT["degree",0.0174532925199433]],)"
    R"(PROJECTION["Transverse_Mercator"],PARAMETER["central_meridian",3],UNIT["metre",1],)";

std::string geojson(std::string const& crs) {
    return R"({"type":"FeatureCollection","crs":)" + crs +
           R"(,"features":[{"type":"Feature","properties":{},"geometry":{"type":"LineString","coordinates":)"
           R"([[500000,5000000],[500300,4999900],[500600,5000000]]}}]})";
}

std::string ogr_vrt(std::string const& source) {
    return "<OGRVRTDataSource><OGRVRTLayer name='rivers'><SrcDataSource>" + source +
           "</SrcDataSource><SrcLayer>secret</SrcLayer></OGRVRTLayer></OGRVRTDataSource>";
}

std::string gdal_vrt(std::string const& source, std::string const& more = "") {
    return "<VRTDataset rasterXSize='64' "
           "rasterYSize='64'><SRS>EPSG:32631</SRS><GeoTransform>499000,60,0,5001000,0,-60</GeoTransform>"
           "<VRTRasterBand dataType='Float32' band='1'" +
           more + "<SimpleSource><SourceFilename relativeToVRT='0'>" + source +
           "</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>";
}

std::string const wms =
    "<GDAL_WMS><Service name='TMS'><ServerUrl>@URL@/${z}/${x}/${y}.png</ServerUrl></Service><DataWindow>"
    "<UpperLeftX>500000</UpperLeftX><UpperLeftY>5000000</UpperLeftY><LowerRightX>501920</LowerRightX>"
    "<LowerRightY>4998080</LowerRightY><TileLevel>1</TileLevel><TileCountX>1</TileCountX><TileCountY>1"
    "</TileCountY></DataWindow><Projection>EPSG:32631</Projection><BandsCount>1</BandsCount></GDAL_WMS>";

std::string const overview =
    "<PAMDataset><Metadata domain='OVERVIEWS'><MDI key='OVERVIEW_FILE'>@@</MDI></Metadata></PAMDataset>";

std::string replaced(std::string text, std::string const& from, std::string const& to) {
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
        text.replace(at, from.size(), to);
    }
    return text;
}

std::string const wfs_xml = "<OGRWFSDataSource><URL>@URL@/wfs?SERVICE=WFS</URL></OGRWFSDataSource>";

std::string const gml =
    "<?xml version='1.0'?><!DOCTYPE a SYSTEM '@URL@/a.dtd'><ogr:FeatureCollection xmlns:ogr='http://ogr.maptools.org/'"
    " xmlns:gml='http://www.opengis.net/gml' xmlns:xsi='http://www.w3.org/2001/XMLSchema-instance'"
    " xsi:schemaLocation='http://ogr.maptools.org/ @URL@/a.xsd'><gml:featureMember><ogr:a "
    "fid='1'><ogr:geometryProperty>"
    "<gml:LineString srsName='@URL@/crs'><gml:coordinates>500000,5000000 500300,4999900</gml:coordinates>"
    "</gml:LineString></ogr:geometryProperty></ogr:a></gml:featureMember></ogr:FeatureCollection>";

std::string const gpx =
    "<?xml version='1.0'?><!DOCTYPE gpx [<!ENTITY e SYSTEM '@OUT@/secret.txt'>]><gpx version='1.1' creator='x' "
    "xmlns='http://www.topografix.com/GPX/1/1'><rte><name>&e;</name><rtept lat='45' lon='3'/>"
    "<rtept lat='45.01' lon='3.01'/></rte></gpx>";

std::string const kml =
    "<?xml version='1.0'?><kml xmlns='http://www.opengis.net/kml/2.2'><Document><NetworkLink><Link><href>@URL@/a.kml"
    "</href></Link></NetworkLink><Placemark><styleUrl>@URL@/a.kml#s</styleUrl><LineString><coordinates>3,45 3.01,45.01"
    "</coordinates></LineString></Placemark></Document></kml>";

std::string const tab = "!table\n!version 300\n!charset Neutral\n\nDefinition Table\n  Type DBF Charset \"Neutral\"\n  "
                        "File \"@OUT@/secret.dbf\"\n"
                        "  Fields 1\n    id Integer ;\n";

/// All that an attacker may send; files that only programs write are in the folder (see strange_files).
std::vector<Trial> trials() {
    std::string const named = R"({"type":"name","properties":{"name":"@URL@/crs"}})";
    std::string const linked = R"({"type":"link","properties":{"href":"@URL@/crs","type":"ogcwkt"}})";
    return {
        // Names that are no files.
        {lines("/vsicurl/@URL@/a.geojson")},
        {lines("@URL@/a.geojson")},
        {lines("WFS:@URL@/wfs")},
        {lines("OAPIF:@URL@/")},
        {lines("CSW:@URL@/")},
        {lines("ES:@URL@")},
        {lines("PG:host=127.0.0.1 port=@PORT@ dbname=x")},
        {lines("postgresql://u:p@127.0.0.1:@PORT@/x")},
        {lines("MYSQL:x,host=127.0.0.1,port=@PORT@,user=u,password=p")},
        {lines("/vsizip//vsicurl/@URL@/a.zip")},
        {lines("/vsigzip//vsicurl/@URL@/a.geojson.gz")},
        {lines("/vsizip/{/vsicurl/@URL@/a.zip}/a.gpkg")},
        {lines("/vsitar//vsicurl_streaming/@URL@/a.tar")},
        {lines("/vsicurl_streaming/@URL@/a.geojson")},
        {lines("/vsiwebhdfs/@URL@/webhdfs/v1/a.geojson")},
        {lines("/vsizip/@OUT@/secret.zip/secret.geojson")},
        {lines("/vsistdin/")},
        {lines("/dev/stdin")},
        {lines(geojson(linked))},
        {lines(replaced(ogr_vrt("/vsicurl/@URL@/a.gpkg"), "'", "\""))},
        {strokes("/vsicurl/@URL@/a.geojson")},
        {strokes("WFS:@URL@/wfs")},
        {points("/vsicurl/@URL@/a.gpkg")},
        {points("WFS:@URL@/wfs")},
        {forest("region", "PG:host=127.0.0.1 port=@PORT@ dbname=x")},
        {forest("outlets", "@URL@/a.geojson")},
        {surface("lakes", "OAPIF:@URL@/")},
        {surface("uplift", "/vsicurl/@URL@/a.tif")},
        {surface("mask", "WMTS:@URL@/a.xml")},
        {surface("erodibility", "NETCDF:\"@URL@/a.nc\":z")},
        {patch("WMS:@URL@/wms?LAYERS=a&SRS=EPSG:32631")},
        {patch("WCS:@URL@/wcs")},
        // Files that name addresses.
        {lines("a.vrt"), {{"a.vrt", ogr_vrt("/vsicurl/@URL@/a.gpkg")}}},
        {lines("a.vrt"), {{"a.vrt", ogr_vrt("PG:host=127.0.0.1 port=@PORT@ dbname=x")}}},
        {lines("a.vrt"), {{"a.vrt", ogr_vrt("WFS:@URL@/wfs")}}},
        {lines("a.xml"), {{"a.xml", wfs_xml}}},
        {lines("a.geojson"), {{"a.geojson", geojson(linked)}}},
        {lines("a.geojson"), {{"a.geojson", geojson(named)}}},
        {lines("a.gml"), {{"a.gml", gml}}},
        {lines("a.kml"), {{"a.kml", kml}}},
        {strokes("a.vrt"), {{"a.vrt", ogr_vrt("/vsicurl/@URL@/a.gpkg")}}},
        {patch("a.xml"), {{"a.xml", wms}}},
        {patch("a.vrt"), {{"a.vrt", gdal_vrt("/vsicurl/@URL@/a.tif", ">")}}},
        {patch("a.vrt"), {{"a.vrt", gdal_vrt("NETCDF:&quot;@URL@/a.nc&quot;:z", ">")}}},
        {patch("ovr.tif"), {{"ovr.tif.ovr", wms}}},
        {patch("msk.tif"), {{"msk.tif.msk", wms}}},
        {patch("pam.tif"), {{"pam.tif.aux.xml", replaced(overview, "@@", "/vsicurl/@URL@/a.tif")}}},
        {lines("link.zip")},
        // Files that name files elsewhere.
        {lines("a.vrt"), {{"a.vrt", ogr_vrt("@OUT@/secret.gpkg")}}},
        {lines("a.json"),
         {{"a.json", R"({"x":"<OGRVRTDataSource>",)" + geojson("null").substr(1) + ogr_vrt("@OUT@/secret.gpkg")}}},
        {lines("a.tab"), {{"a.tab", tab}}},
        {lines("a.gpx"), {{"a.gpx", gpx}}},
        {lines("vrt.zip")},
        {lines("virtual.gpkg")},
        {points("a.vrt"), {{"a.vrt", ogr_vrt("@OUT@/secret.gpkg")}}},
        {forest("region", "a.vrt"), {{"a.vrt", ogr_vrt("@OUT@/secret.gpkg")}}},
        {patch("a.vrt"), {{"a.vrt", gdal_vrt("@OUT@/secret.tif", ">")}}},
        {patch("a.vrt"),
         {{"a.vrt", gdal_vrt("../elsewhere/secret.tif",
                             " subClass='VRTDerivedRasterBand'><PixelFunctionLanguage>Python"
                             "</PixelFunctionLanguage><PixelFunctionType>os.system</PixelFunctionType>")}}},
        {patch("ovr.tif"), {{"ovr.tif.ovr", gdal_vrt("@OUT@/secret.tif", ">")}}},
        {patch("pam.tif"), {{"pam.tif.aux.xml", replaced(overview, "@@", "@OUT@/secret.tif")}}},
        {patch("inner.tif")},
        {surface("uplift", "a.vrt"), {{"a.vrt", gdal_vrt("@OUT@/secret.tif", ">")}}},
        // Files that never end, and coordinate systems.
        {lines("fifo.geojson")},
        {points("fifo.csv")},
        {patch("fifo.tif")},
        {valley + "crs = 'x'\n[surface]\n"},
        {"[grid]\nwidth = 64\nheight = 64\ncrs = '@URL@/crs'\n[network]\n[network.dla]\nparticles = 400\n"},
        {"[grid]\nwidth = 64\nheight = 64\ncrs = '@OUT@/secret.prj'\n[network]\n[network.dla]\nparticles = 400\n"},
        // Grids of datums: PROJ opens them.
        {in_crs("+proj=utm +zone=31 +ellps=clrk66 +nadgrids=@OUT@/secret.gsb +units=m +no_defs")},
        {in_crs("+proj=utm +zone=31 +ellps=clrk66 +nadgrids=@@OUT@/secret.gsb,null +units=m")},
        {in_crs("+proj=utm +zone=31 +ellps=clrk66 +nadgrids=../elsewhere/secret.gsb +units=m")},
        {in_crs("+proj=utm +zone=31 +geoidgrids=@OUT@/secret.gtx +units=m +vunits=m")},
        {in_crs("+init=@OUT@/secret.txt:1")},
        {in_crs("+proj=pipeline +step +proj=tinshift +file=@OUT@/secret.txt")},
        {in_crs("+proj=pipeline +step +proj=xyzgridshift +grids=@OUT@/secret.tif")},
        {in_crs(projected + "EXTENSION[\"PROJ4\",\"+proj=utm +zone=31 +nadgrids=@OUT@/secret.gsb\"]]")},
        {lines("grid.gpkg")},
        {lines("grid.shp")},
        {lines("geoid.gpkg")},
        {lines("grid.geojson")},
        {patch("grid.tif")},
        {points("grid.shp")},
        {forest("region", "grid.gpkg")},
    };
}

/// What only programs write. Of a table that a program answers: a reader of text by SpatiaLite.
char const* const strange_files = R"py(
import os, sqlite3, sys, zipfile
from osgeo import gdal, ogr, osr
gdal.UseExceptions()
out = sys.argv[1]
srs = osr.SpatialReference(); srs.ImportFromEPSG(32631)
def rivers(path, driver='GPKG', name='secret', srs=srs):
    data = ogr.GetDriverByName(driver).CreateDataSource(path)
    layer = data.CreateLayer(name, srs, ogr.wkbLineString)
    layer.CreateField(ogr.FieldDefn('id', ogr.OFTInteger))
    feature = ogr.Feature(layer.GetLayerDefn())
    feature.SetGeometry(ogr.CreateGeometryFromWkt('LINESTRING(500000 5000000,500300 4999900,500600 5000000)'))
    layer.CreateFeature(feature)
def dem(path, metadata={}, srs=srs):
    data = gdal.GetDriverByName('GTiff').Create(path, 64, 64, 1, gdal.GDT_Float32)
    data.SetGeoTransform((499000, 60, 0, 5001000, 0, -60)); data.SetProjection(srs.ExportToWkt())
    data.GetRasterBand(1).Fill(100)
    if metadata: data.SetMetadata(metadata, 'OVERVIEWS')
rivers(out + '/secret.gpkg'); rivers(out + '/secret.shp', 'ESRI Shapefile'); rivers(out + '/secret.geojson', 'GeoJSON')
dem(out + '/secret.tif')
def bound(grids):
    srs = osr.SpatialReference()
    srs.ImportFromProj4('+proj=utm +zone=31 +ellps=clrk66 +units=m +no_defs ' + grids)
    return srs
gdal.DontUseExceptions(); gdal.PushErrorHandler('CPLQuietErrorHandler') # the grid is not there
of_datum = bound('+nadgrids=' + out + '/secret.gsb')
for name, driver in (('gpkg', 'GPKG'), ('shp', 'ESRI Shapefile')): rivers('grid.' + name, driver, srs=of_datum)
rivers('geoid.gpkg', srs=bound('+geoidgrids=' + out + '/secret.gtx +vunits=m'))
dem('grid.tif', srs=of_datum)
open('grid.geojson', 'w').write(open(out + '/secret.geojson').read().replace('"name": "urn:ogc:def:crs:EPSG::32631"',
                                '"name": "+proj=utm +zone=31 +ellps=clrk66 +nadgrids=' + out + '/secret.gsb +units=m"'))
gdal.PopErrorHandler(); gdal.UseExceptions()
open(out + '/secret.gsb', 'w').write('secret'); open(out + '/secret.gtx', 'w').write('secret')
open(out + '/secret.txt', 'w').write('secret\n'); open(out + '/secret.csv', 'w').write('a,b\n1,2\n')
open(out + '/secret.prj', 'w').write(srs.ExportToWkt())
with zipfile.ZipFile(out + '/secret.zip', 'w') as z: z.write(out + '/secret.geojson', 'secret.geojson')
for name in ('ovr', 'msk', 'pam'): dem(name + '.tif')
dem('inner.tif', {'OVERVIEW_FILE': out + '/secret.tif'})
with zipfile.ZipFile('link.zip', 'w') as z: z.writestr('a.geojson', sys.argv[2])
with zipfile.ZipFile('vrt.zip', 'w') as z: z.writestr('a.vrt', sys.argv[3])
rivers('virtual.gpkg', name='rivers')
base = sqlite3.connect('virtual.gpkg')
base.execute('PRAGMA writable_schema = 1')
base.execute("INSERT INTO sqlite_master VALUES('table', 'spy', 'spy', 0, 'CREATE VIRTUAL TABLE spy USING VirtualText(''"
             + out + "/secret.csv'', UTF-8, 1)')")
base.execute("INSERT INTO gpkg_contents(table_name, data_type, identifier) VALUES('spy', 'attributes', 'spy')")
base.commit()
for name in ('geojson', 'csv', 'tif'): os.mkfifo('fifo.' + name)
)py";

class Hostile : public testing::Test {
protected:
    void SetUp() override {
        fs::create_directories(inside());
        fs::create_directories(elsewhere());
        place_.write("strange.py", strange_files);
        std::string const link =
            filled(geojson(R"({"type":"link","properties":{"href":"@URL@/crs","type":"ogcwkt"}})"));
        std::string const command = "cd '" + inside().string() + "' && /usr/bin/python3 ../strange.py '" +
                                    elsewhere().string() + "' '" + link + "' \"" +
                                    ogr_vrt(elsewhere().string() + "/secret.gpkg") + "\"";
        ASSERT_EQ(std::system(command.c_str()), 0);
    }

    fs::path inside() const { return place_ / "inside"; }
    fs::path elsewhere() const { return place_ / "elsewhere"; }

    std::string filled(std::string text) const {
        text = replaced(std::move(text), "@URL@", "http://127.0.0.1:" + door_.port());
        text = replaced(std::move(text), "@PORT@", door_.port());
        return replaced(std::move(text), "@OUT@", elsewhere().string());
    }

    /// Runs with the files in place and removes them again.
    Outcome run(std::string const& arguments, Files const& files) {
        for (auto const& [name, text] : files) {
            place_.write("inside/" + name, filled(text));
        }
        Outcome const outcome = thalweg_run(filled(arguments), inside());
        for (auto const& [name, text] : files) {
            fs::remove(inside() / name);
        }
        fs::remove_all(inside() / "out");
        return outcome;
    }

    Workplace place_;
    Door door_;
};

} // namespace

TEST_F(Hostile, ARecipeConnectsToNothingAndOpensNothingElsewhere) {
    Eye eye(elsewhere());
    std::vector<Trial> const all = trials();
    ASSERT_GE(all.size(), 40U);
    for (auto const& [name, arguments] :
         {std::pair("r.toml", "make r.toml -o out"), std::pair("recipe.toml", "replay . --verify")}) {
        int refused = 0;
        for (Trial const& trial : all) {
            Files files = trial.files;
            files.emplace_back(name, trial.recipe);
            Outcome const o = run(arguments, files);
            SCOPED_TRACE(arguments + ("\n" + filled(trial.recipe)) + o.err);
            EXPECT_EQ(door_.take_guests(), 0);
            EXPECT_EQ(eye.take_opened(), "");
            EXPECT_TRUE(o.code == 0 || o.code == 2 || o.code == 3) << o.code;
            refused += o.code == 2 && test::has(o.err, "error: ") ? 1 : 0;
        }
        EXPECT_GE(refused, 60) << arguments;
    }
}

TEST_F(Hostile, GridsOfDatumsOutsideTheFoldersOfProjAreNamed) {
    Eye eye(elsewhere());
    Files const files{
        {"crs.toml", in_crs("+proj=utm +zone=31 +ellps=clrk66 +nadgrids=@OUT@/secret.gsb +units=m +no_defs")},
        {"lines.toml", lines("grid.gpkg")}};
    for (std::string const arguments :
         {"make crs.toml -o out", "make lines.toml -o out", "make grid.gpkg -o out", "make grid.shp -o out",
          "recipe --for grid.gpkg", "tin grid.gpkg -o a.ply --crs '+proj=utm +zone=31 +nadgrids=@OUT@/secret.gsb'",
          "make -o out --set network.dla.particles=400 --crs '+proj=utm +zone=31 +nadgrids=@OUT@/secret.gsb'"}) {
        Outcome const o = run(arguments, files);
        EXPECT_EQ(eye.take_opened(), "") << arguments << "\n" << o.err;
        EXPECT_EQ(o.code, 2) << arguments << "\n" << o.err;
    }
}

TEST_F(Hostile, NothingOfAnyOtherFileIsShown) {
    fs::create_directory(place_ / "etc");
    place_.write("etc/passwd", "root:x:0:0:the root::/bin/sh\n");
    place_.write("etc/shadow", "root:secret\n");
    std::string const passwd = (place_ / "etc/passwd").string();
    Eye eye(place_ / "etc");
    for (std::string const& recipe :
         {lines(passwd), strokes(passwd), points(passwd), patch(passwd), forest("region", passwd),
          forest("outlets", passwd), surface("lakes", passwd), surface("uplift", passwd), surface("mask", passwd),
          surface("erodibility", passwd), surface("like", passwd)}) {
        Outcome const o = run("make r.toml -o out", {{"r.toml", recipe}});
        EXPECT_EQ(o.code, 2) << recipe << o.err;
        EXPECT_FALSE(test::has((o.out + o.err), "root")) << recipe;
        EXPECT_FALSE(test::has(eye.take_opened(), "shadow")) << recipe;
    }
}

TEST_F(Hostile, FilesOnTheCommandLineAreReadWithoutAConnection) {
    Files const files{{"lines.vrt", ogr_vrt("/vsicurl/@URL@/a.gpkg")},
                      {"base.vrt", ogr_vrt("PG:host=127.0.0.1 port=@PORT@ dbname=x")},
                      {"wfs.xml", wfs_xml},
                      {"wms.xml", wms},
                      {"dem.vrt", gdal_vrt("/vsicurl/@URL@/a.tif", ">")},
                      {"nc.vrt", gdal_vrt("NETCDF:&quot;@URL@/a.nc&quot;:z", ">")},
                      {"link.geojson", geojson(R"({"type":"link","properties":{"href":"@URL@/crs","type":"ogcwkt"}})")},
                      {"a.gml", gml},
                      {"ovr.tif.ovr", wms},
                      {"pam.tif.aux.xml", replaced(overview, "@@", "/vsicurl/@URL@/a.tif")}};
    for (std::string const arguments : {"make lines.vrt -o out",
                                        "make base.vrt -o out",
                                        "make wfs.xml -o out",
                                        "make link.geojson -o out",
                                        "make a.gml -o out",
                                        "check lines.vrt",
                                        "check link.geojson",
                                        "check a.gml",
                                        "convert base.vrt -o b.gpkg",
                                        "recipe --for link.geojson",
                                        "stats dem.vrt",
                                        "stats nc.vrt",
                                        "stats wms.xml",
                                        "stats ovr.tif",
                                        "stats pam.tif",
                                        "draw dem.vrt -o out",
                                        "draw wms.xml -o out",
                                        "tin lines.vrt -o a.ply",
                                        "points dem.vrt -o a.las",
                                        "make --set patch.1.source=dem.vrt --set network.dla.particles=400 -o out"}) {
        Outcome const o = run(arguments, files);
        EXPECT_EQ(door_.take_guests(), 0) << arguments << "\n" << o.err;
        bool const is_fine = arguments == "stats ovr.tif" || arguments == "stats pam.tif";
        EXPECT_TRUE(o.code == 2 || o.code == 1 || (is_fine && o.code == 0)) << arguments << " " << o.code << "\n"
                                                                            << o.err;
    }
}

// A name that says .vrt may lead anywhere; under another one a virtual file stays in its folder, and none reads the
// bytes of what is no raster.
TEST_F(Hostile, VirtualFilesUnderOtherNamesStayInTheirFolder) {
    fs::copy_file(elsewhere() / "secret.tif", inside() / "near.tif");
    fs::copy_file(elsewhere() / "secret.gpkg", inside() / "near.gpkg");
    std::string const raw = "<VRTDataset rasterXSize='64' rasterYSize='64'><VRTRasterBand dataType='Byte' band='1' "
                            "subClass='VRTRawRasterBand'><SourceFilename relativetoVRT='1'>near.tif</SourceFilename>"
                            "</VRTRasterBand></VRTDataset>";
    auto const near = [](std::string const& name) {
        return replaced(gdal_vrt(name, ">"), "relativeToVRT='0'", "relativeToVRT='1'");
    };
    std::string const inline_raw = replaced(replaced(raw, "<", "&lt;"), "'", "&quot;");
    Files const files{
        {"far.vrt", gdal_vrt("@OUT@/secret.tif", ">")},
        {"far.tif", gdal_vrt("@OUT@/secret.tif", ">")},
        {"up.tif", near("../elsewhere/secret.tif")},
        {"near.vrt", near("near.tif")},
        {"near.png", near("near.tif")},
        {"nested.tif", near("far.vrt")},
        {"raw.vrt", raw},
        {"raw.tif", raw},
        {"of_raw.vrt", near("raw.vrt")},
        {"scheme.vrt", near("vrt://raw.vrt?bands=1")},
        {"within.vrt", gdal_vrt(inline_raw, ">")},
        {"lines.vrt", replaced(ogr_vrt("near.gpkg"), "<SrcDataSource>", "<SrcDataSource relativeToVRT='1'>")},
        {"lines.gml", replaced(ogr_vrt("@OUT@/secret.gpkg"), ">secret<", ">secret<")}};
    for (char const* const fine : {"stats far.vrt", "stats near.vrt", "stats near.png", "draw far.vrt -o out"}) {
        Outcome const o = run(fine, files);
        EXPECT_EQ(o.code, 0) << fine << "\n" << o.err;
    }
    std::string const elsewhere_words = "rename it to .vrt";
    for (std::string const& command : std::vector<std::string>{
             "stats @ --json", "draw @ -o out", "check " + samples + "walker_nhdplus.gpkg --dem @", "points @ -o a.las",
             "export @ --for unity -o out", "deform @ --scale 2 --mask near.tif -o out.tif",
             "make --set grid.width=64 --set grid.height=64 --set surface.uplift=@ -o out",
             "make --set patch.1.source=@ --set network.dla.particles=400 -o out",
             "blend near.tif @ --at 500900,4999000 -o out.tif"}) {
        for (char const* const name :
             {"far.tif", "up.tif", "nested.tif", "raw.vrt", "raw.tif", "of_raw.vrt", "scheme.vrt", "within.vrt"}) {
            Outcome const o = run(replaced(command, "@", name), files);
            EXPECT_EQ(o.code, 2) << command << " " << name << "\n" << o.err;
            bool const is_raw = std::string(name).find("raw") != std::string::npos ||
                                std::string(name) == "scheme.vrt" || std::string(name) == "within.vrt";
            EXPECT_TRUE(test::has(o.err, is_raw ? "reads the bytes of another file" : elsewhere_words))
                << command << " " << name << "\n"
                << o.err;
        }
    }
    EXPECT_TRUE(test::has(run("check lines.gml", files).err, elsewhere_words));
}

TEST_F(Hostile, ConnectionsThatTheCommandLineNamesAreMade) {
    for (std::string const name : {"PG:host=127.0.0.1 port=@PORT@ dbname=x", "/vsicurl/@URL@/a.geojson"}) {
        Outcome const o = run("make '" + name + "' -o out", {});
        EXPECT_EQ(o.code, 2) << o.err;
        EXPECT_GT(door_.take_guests(), 0) << name << "\n" << o.err;
        Outcome const set = run("make --set network.source=lines --set network.lines.path='" + name + "' -o out", {});
        EXPECT_EQ(set.code, 2) << set.err;
        EXPECT_GT(door_.take_guests(), 0) << name << "\n" << set.err;
    }
}

TEST_F(Hostile, WhatAVrtNamesIsKeptAndReplays) {
    Files const files{{"rivers.vrt", ogr_vrt("@OUT@/secret.gpkg")}, {"hills.vrt", gdal_vrt("@OUT@/secret.tif", ">")}};
    for (auto const& [name, text] : files) {
        place_.write("inside/" + name, filled(text));
    }
    Outcome const made =
        thalweg_run("make rivers.vrt --set grid.cell=10 --set surface.uplift=hills.vrt -o made", inside());
    ASSERT_EQ(made.code, 0) << made.err;
    for (char const* const gone : {"rivers.vrt", "hills.vrt"}) {
        fs::remove(inside() / gone);
    }
    fs::remove_all(elsewhere());
    EXPECT_TRUE(fs::exists(inside() / "made/inputs/rivers.gpkg")) << file_bytes(inside() / "made/recipe.toml");
    EXPECT_TRUE(fs::exists(inside() / "made/inputs/uplift/hills.tif")) << file_bytes(inside() / "made/recipe.toml");
    Outcome const again = thalweg_run("replay made --verify", inside());
    EXPECT_EQ(again.code, 0) << again.out << again.err;
}

} // namespace hostile_test

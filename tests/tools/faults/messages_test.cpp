// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What messages are made of comes from files and command lines: they neither act on the terminal, nor flood it, nor
// tell passwords.
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/messages.hpp>

#include "command.hpp"

namespace messages_test {

namespace fs = std::filesystem;
using thalweg::is_utf8;

namespace {

std::string const evil = "\033]0;gone\007\033[31mred\r\x9b"
                         "2J";
std::string const shell_evil = "$(printf '\\033]0;gone\\007\\033[31mred\\r')";

bool acts(std::string const& text) {
    return std::ranges::any_of(text, [](char c) {
        auto const byte = static_cast<unsigned char>(c);
        return (byte < 0x20 && c != '\n' && c != '\t') || byte == 0x7F;
    });
}

std::string geojson(std::string const& property, std::string const& geometry) {
    return R"({"type":"FeatureCollection","name":"l\u001b[31mred","crs":{"type":"name","properties":{"name":)"
           R"("urn:ogc:def:crs:EPSG::32631"}},"features":[{"type":"Feature","properties":{)" +
           property + R"(},"geometry":)" + geometry + "}]}";
}

std::string const line = R"({"type":"LineString","coordinates":[[500000,5000000],[500300,4999900],[500600,5000000]]})";

std::string lines_recipe(std::string const& more) {
    return "[grid]\ncell = 10\n[network]\nsource = \"lines\"\n[network.lines]\npath = \"r.geojson\"\n" + more +
           "[surface]\n";
}

} // namespace

TEST(Messages, ControlCharactersDoNotReachTheTerminal) {
    Workplace const place;
    place.write("key.toml", "\"a\\u001b[31mred\" = 1\n");
    place.write("section.toml", "[\"a\\u001b[31mred\"]\nb = 1\n");
    place.write("value.toml", "[surface]\nmethod = \"a\\u001b[31mred\"\n");
    place.write("crs.toml", "[grid]\ncrs = \"a\\u001b[31mred\"\nwidth = 64\nheight = 64\n[network]\n");
    place.write("file.toml", "[network]\nsource = \"lines\"\n[network.lines]\npath = \"a\\u001b[31mred\"\n[surface]\n");
    place.write("broken.toml", "a = \033[31m\n");
    place.write("r.geojson", geojson(R"("lambda":"a\u001b[31mred","f\u001b[31mred":1)", line));
    place.write("layer.toml", lines_recipe("layer = \"x\\u001b[31mred\"\n"));
    place.write("lambda.toml", "[network]\nsource = \"tokunaga\"\n[network.tokunaga]\nstrokes = \"r.geojson\"\n");
    place.write("field.toml", lines_recipe("type_field = \"f2\"\n"));
    place.write("points.csv", "x,y,z\n1,2," + evil + "\n");
    place.write("points.toml", "[grid]\nwidth = 9\nheight = 9\n[skeleton]\npoints = \"points.csv\"\n");
    place.write("name" + evil.substr(1, 4) + "\033[31m.geojson", "{");
    int refused = 0;
    std::vector<std::string> lines{"check name*.geojson"};
    for (std::string const recipe :
         {"key", "section", "value", "crs", "file", "broken", "layer", "lambda", "field", "points"}) {
        lines.push_back("make " + recipe + ".toml -o out");
    }
    for (std::string line : {"make \"@\" -o out", "make --set \"@=1\"", "make --set \"surface.method=@\"",
                             "stats \"@\"", "check \"@\"", "check r.geojson --layer \"@\"", "\"@\"", "make \"--@\"",
                             "make --crs \"@\" -o out", "convert \"@\" -o a.gpkg", "recipe \"@\""}) {
        lines.push_back(line.replace(line.find('@'), 1, shell_evil));
    }
    for (std::string const& arguments : lines) {
        Outcome const o = thalweg_run(arguments, place.path());
        EXPECT_FALSE(acts(o.err)) << arguments << "\n" << o.err;
        EXPECT_FALSE(acts(o.out)) << arguments << "\n" << o.out;
        EXPECT_TRUE(o.code == 2 || o.code == 3) << arguments << " " << o.code << "\n" << o.err;
        refused += o.err.find("\\x1b[31m") != std::string::npos ? 1 : 0;
    }
    EXPECT_GE(refused, 16) << "what is escaped is still shown";
}

TEST(Messages, AreCutAndSayHowMuchIsLeftOut) {
    Workplace const place;
    std::string keys;
    for (int i = 0; i < 100; ++i) {
        keys += std::string(8000, 'k') + std::to_string(i) + " = 1\n";
    }
    place.write("keys.toml", keys);
    place.write("points.csv", "x,y,z\n1,2," + std::string(10'000'000, '7') + "x\n");
    place.write("points.toml", "[grid]\nwidth = 9\nheight = 9\n[skeleton]\npoints = \"points.csv\"\n");
    place.write("r.geojson", geojson(R"("lambda":")" + std::string(1'000'000, 'y') + "\"", line));
    place.write("lambda.toml", "[network]\nsource = \"tokunaga\"\n[network.tokunaga]\nstrokes = \"r.geojson\"\n");
    for (std::string const recipe : {"keys.toml", "points.toml", "lambda.toml"}) {
        Outcome const o = expect_run(place, "make " + recipe + " -o out", 2);
        EXPECT_LT(o.err.size(), 8000U) << recipe;
    }
    EXPECT_TRUE(test::has(thalweg_run("make lambda.toml -o out", place.path()).err, " bytes left out ...]"));
}

TEST(Messages, PasswordsAreNotEchoed) {
    Workplace const place;
    for (std::string const name :
         {"PG:host=127.0.0.1 port=1 dbname=x password=geheim user=y",
          "PG:host=127.0.0.1 port=1 dbname=x password='ge heim'", "postgresql://y:geheim@127.0.0.1:1/x"}) {
        for (std::string const before : {"make", "check", "convert -o a.gpkg", "recipe --for", "stats", "draw -o out",
                                         "make -o out --set network.source=lines --set network.lines.path=r --set"}) {
            std::string const word = before.ends_with("--set") ? "network.lines.path=" + name : name;
            Outcome const o = thalweg_run(before + " \"" + word + "\"", place.path());
            EXPECT_NE(o.code, 0) << o.err;
            EXPECT_FALSE(test::has(o.err, "heim")) << before << name << "\n";
        }
    }
    place.write("r.toml",
                "[network]\nsource = \"lines\"\n[network.lines]\npath = \"PG:dbname=x password=geheim\"\n[surface]\n");
    Outcome const o = thalweg_run("make r.toml -o out", place.path());
    EXPECT_TRUE(test::has(o.err, "password=..."));
}

TEST(Messages, TmpdirThatDoesNotExistIsNamed) {
    Workplace const place;
    expect_run(place, small + "out", 0);
    place.shell("TMPDIR=/nonexistent '" THALWEG_EXE "' replay out 2>err; test $? = 1");
    EXPECT_TRUE(test::has(file_bytes(place / "err"), "TMPDIR=/nonexistent"));
}

TEST(Messages, ADatabaseOfProjThatDoesNotOpenIsNamed) {
    Workplace const place;
    std::ofstream(place / "proj.db").close();
    for (char const* const name : {"PROJ_DATA", "PROJ_LIB"}) {
        setenv(name, place.path().c_str(), 1);
    }
    Outcome const o = thalweg_run(small + "out --set grid.crs=EPSG:32631", place.path());
    for (char const* const name : {"PROJ_DATA", "PROJ_LIB"}) {
        unsetenv(name);
    }
    EXPECT_EQ(o.code, 1) << "nothing is wrong with the recipe: " << o.err;
    EXPECT_TRUE(test::has(o.err, "PROJ does not open its database"));
}

TEST(Messages, TextThatIsNotUtf8IsRefused) {
    Workplace const place;
    expect_run(place, small + "out --set \"output.title=$(printf 'a\\377b')\"", 2);
    EXPECT_FALSE(fs::exists(place / "out"));
}

TEST(Messages, NamesThatAreNotUtf8AreEscaped) {
    Workplace const place;
    place.write("name.toml",
                "[network]\nsource = \"lines\"\n[network.lines]\npath = \"a\xff\xfe\033.gpkg\"\n[surface]\n");
    place.write("escaped.toml",
                "[network]\nsource = \"lines\"\n[network.lines]\npath = \"\\u009b31m.gpkg\"\n[surface]\n");
    place.write("\xff\x9b.gpkg", "no data");
    std::string const name = "\"$(printf '\\377\\233.gpkg')\"";
    for (std::string const& arguments :
         {std::string("make name.toml -o out"), std::string("make escaped.toml -o out"), "make " + name + " -o out",
          "check " + name, "stats " + name, "draw " + name + " -o out", "export " + name + " -o a.glb",
          "tin " + name + " -o a.ply", "recipe --for " + name, "convert " + name + " -o b.gpkg",
          "make -o out --set network.source=lines --set network.lines.path=" + name}) {
        Outcome const o = expect_run(place, arguments, 2);
        EXPECT_TRUE(is_utf8(o.err) && is_utf8(o.out)) << arguments << o.err;
        EXPECT_FALSE(acts(o.err)) << arguments << o.err;
        EXPECT_FALSE(test::has(o.err, "\xc2\x9b")) << arguments;
    }
}

TEST(Messages, ARecipeHoldsNoNameThatIsNotUtf8) {
    Workplace const place;
    place.write("\xff.geojson", geojson("", line));
    std::string const name = "\"$(printf '\\377.geojson')\"";
    Outcome const printed = expect_run(place, "recipe --for " + name, 2);
    EXPECT_EQ(printed.out, "");
    EXPECT_TRUE(test::has(printed.err, "\\xff.geojson is not UTF-8, and recipes are"));
    expect_run(place, "make " + name + " -q -o out --set grid.cell=10", 0);
    EXPECT_TRUE(is_utf8(file_bytes(place / "out/recipe.toml"))) << "the copy in inputs has another name";
    expect_run(place, "replay out --verify", 0);
}

TEST(Messages, AttributesThatAreNotUtf8AreWrittenEscaped) {
    Workplace const place;
    place.write("make.py", R"py(
from osgeo import ogr, osr
s = osr.SpatialReference(); s.ImportFromEPSG(32631)
d = ogr.GetDriverByName('ESRI Shapefile').CreateDataSource('r.shp')
l = d.CreateLayer('r', s, ogr.wkbLineString, ['ENCODING='])
for name in ('rosgen', 'nXYZ'): l.CreateField(ogr.FieldDefn(name, ogr.OFTString))
f = ogr.Feature(l.GetLayerDefn()); f.SetField(1, 'MARK1')
f.SetGeometry(ogr.CreateGeometryFromWkt('LINESTRING(500000 5000000,500300 4999900,500600 5000000)'))
l.CreateFeature(f); d = None
b = open('r.dbf', 'rb').read()
open('r.dbf', 'wb').write(b.replace(b'nXYZ', b'n\xe4\xff\x1b').replace(b'MARK1', b'M\xfcl\xff\xc3'))
)py");
    place.write("read.py", R"py(
import sys
from osgeo import ogr
for name in sys.argv[1:]:
    d = ogr.Open(name); l = d.GetLayerByName('arcs') or d.GetLayer(0)
    fields = [l.GetLayerDefn().GetFieldDefn(i).GetName() for i in range(l.GetLayerDefn().GetFieldCount())]
    print([n for n in fields if n.startswith('n\\')], l.GetNextFeature().GetField(fields[-1]))
)py");
    std::string const into = "cd '" + place.path().string() + "' && /usr/bin/python3 ";
    ASSERT_EQ(std::system((into + "make.py && rm -f r.cpg").c_str()), 0);
    expect_run(place, "make r.shp --set grid.cell=10 -o out", 0);
    EXPECT_TRUE(test::has(file_bytes(place / "out/report.json"), "not_utf8"));
    ASSERT_EQ(std::system((into + "read.py out/network.gpkg out/network_arcs.shp >seen").c_str()), 0);
    std::string const seen = file_bytes(place / "seen");
    EXPECT_EQ(seen.substr(0, seen.find('\n')), "['n\\\\xe4\\\\xff\\\\x1b'] M\\xfcl\\xff\\xc3") << seen;
    for (auto const& entry : fs::directory_iterator(place / "out")) {
        bool const is_text = entry.is_regular_file() &&
                             std::string(".json .html .toml .svg").find(entry.path().extension()) != std::string::npos;
        EXPECT_TRUE(!is_text || is_utf8(file_bytes(entry.path()))) << entry.path();
    }
    expect_run(place, "replay out --verify", 0);
}

} // namespace messages_test

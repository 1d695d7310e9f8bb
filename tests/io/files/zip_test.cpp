// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/files/zip.hpp>

#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/files/files.hpp>

namespace zip_test {

using namespace thalweg;

// Python's zipfile, which checks sizes and checksum, reads name, date, mode and bytes.
TEST(Zip, PythonReadsTheFileItsDateAndItsMode) {
    io::TemporaryFolder const folder("thalweg");
    std::string const path = (folder.path() / "a.zip").string();
    std::string bytes = "seven!\n";
    bytes += '\0';
    bytes += '\xff';
    io::write_text(path, io::zip_archive("a/b.txt", bytes));
    std::string const reads = "python3 -c \"import zipfile; z = zipfile.ZipFile('" + path +
                              "'); e, = z.infolist(); assert z.testzip() is None; "
                              "assert e.filename == 'a/b.txt' and e.date_time == (1980, 1, 1, 0, 0, 0), e; "
                              "assert e.external_attr >> 16 == 0o100644 and e.compress_type == 0, e; "
                              "assert z.read(e) == b'seven!\\n\\x00\\xff', z.read(e)\"";
    EXPECT_EQ(std::system(reads.c_str()), 0);
}

// The bytes of an archive of an empty file, by hand from the specification.
TEST(Zip, AnEmptyFile) {
    std::string const fields("\x0a\0\0\0\0\0\0\0\x21\0\0\0\0\0\0\0\0\0\0\0\0\0\x01\0\0\0", 26);
    std::string const wanted = "PK\x03\x04" + fields + "x" + "PK\x01\x02" + std::string("\x0a\x03", 2) + fields +
                               std::string("\0\0\0\0\0\0\0\0\xa4\x81\0\0\0\0", 14) + "x" + "PK\x05\x06" +
                               std::string("\0\0\0\0\x01\0\x01\0\x2f\0\0\0\x1f\0\0\0\0\0", 18);
    EXPECT_EQ(io::zip_archive("x", ""), wanted);
}

TEST(Zip, ANameThatFitsNoHeaderIsRefused) {
    EXPECT_NO_THROW(io::zip_archive(std::string(65535, 'a'), ""));
    EXPECT_THROW(io::zip_archive(std::string(65536, 'a'), ""), BadParameter);
    EXPECT_THROW(io::zip_archive("", ""), BadParameter);
}

} // namespace zip_test

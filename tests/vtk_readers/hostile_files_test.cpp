// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Files made to read what they should not, or never to end, in the formats that VTK and HDF5 read.
#include <sys/stat.h>

#include <gtest/gtest.h>

#include <isotet/read.hpp>

#include "support/places.hpp"
#include "support/temporary_folder.hpp"
#include "vtk_readers/hdf5_writer.hpp"

namespace isotet::test {
namespace {

class HostileFile : public testing::Test {
protected:
    static std::string message_of(const std::string& path) {
        const auto result = read(path);
        if (!result) return result.error().message;
        return result->info.left_out.empty() ? "read" : result->info.left_out.front().reason;
    }
    static void expect_error(const std::string& path, std::initializer_list<std::string_view> words) {
        const std::string message = message_of(path);
        for (const std::string_view word : words) EXPECT_NE(message.find(word), std::string::npos) << message;
    }

    /// Two tetrahedra in EnSight Gold.
    std::string ensight(const std::string& variables) const {
        folder_.write("case/grid.geo",
                      "one\ntwo\nnode id off\nelement id off\npart\n1\nsolid\ncoordinates\n5\n0\n1\n0\n0\n0\n"
                      "0\n0\n1\n0\n0\n0\n0\n0\n1\n-1\ntetra4\n2\n1 2 3 4\n1 3 2 5\n");
        return folder_.write("case/a.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: grid.geo\n" + variables);
    }
    /// The same in VTKHDF, with what `add` puts into it.
    template <class Add>
    std::string vtkhdf(Add add) const {
        std::filesystem::create_directories(folder_.file("case"));
        const std::string path = folder_.file("case/a.hdf");
        Hdf5Writer file(path);
        write_two_tets(file);
        add(file);
        return path;
    }
    TemporaryFolder folder_;
};

using HostileEnsight = HostileFile;

TEST_F(HostileEnsight, NamesThatFollowTheFileNameAreLookedAt) {
    folder_.write("secret", "values\npart\n1\ncoordinates\n1\n2\n3\n4\n5\n");
    expect_error(ensight("VARIABLE\nscalar per node: t constant per case ../secret\n"), {"only files below"});
    expect_error(ensight("VARIABLE\nscalar per node: t t.scl ../secret\n"), {"only files below"});
}

TEST_F(HostileEnsight, LinksThatLeadOutsideAreNotFollowed) {
    ASSERT_TRUE(reader_confinement().files) << "this system has no Landlock";
    folder_.write("secret", "values\npart\n1\ncoordinates\n1\n2\n3\n4\n5\n");
    const std::string path = ensight("VARIABLE\nscalar per node: t t.scl\n");
    std::filesystem::create_symlink("../secret", folder_.file("case/t.scl"));
    EXPECT_NE(message_of(path), "read");
    ReadOptions options;
    options.allow_outside = true;
    const auto allowed = read(path, options);
    ASSERT_TRUE(allowed) << allowed.error().message;
    EXPECT_EQ(allowed->grid.point_fields.at(0).values.at(4), 5);
}

TEST_F(HostileEnsight, APipeIsAnErrorAndNotWaitedFor) {
    const std::string path = ensight("VARIABLE\nscalar per node: t t.scl\n");
    ASSERT_EQ(::mkfifo(folder_.file("case/t.scl").c_str(), 0600), 0);
    EXPECT_NE(message_of(path), "read");
}

TEST_F(HostileEnsight, MeasuredPointsAreNotRead) {
    const std::string path = ensight("");
    folder_.write("case/steps.geo",
                  "BEGIN TIME STEP\n" + content_of(folder_.file("case/grid.geo")) + "END TIME STEP\n");
    folder_.write("case/points", "measured\nparticle coordinates\n0\n");
    folder_.write("case/a.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: 1 1 steps.geo\nmeasured: 1 1 points\n"
                                 "TIME\ntime set: 1\nnumber of steps: 1\ntime values: 0\n"
                                 "FILE\nfile set: 1\nnumber of steps: 1\n");
    EXPECT_EQ(message_of(path), "read");
}

using HostileHdf5 = HostileFile;

TEST_F(HostileHdf5, LinksToFilesOutsideAreErrors) {
    {
        Hdf5Writer other(folder_.file("other.h5"));
        other.data<double>("/p", {1, 2, 3, 4, 5}, {5});
    }
    expect_error(vtkhdf([](Hdf5Writer& file) { file.external_link("/VTKHDF/PointData/p", "../other.h5", "/p"); }),
                 {"/VTKHDF/PointData/p", "../other.h5", "only files below"});
}

TEST_F(HostileHdf5, DataStoredInFilesOutsideIsAnError) {
    folder_.write("secret", std::string(40, 'x'));
    expect_error(vtkhdf([](Hdf5Writer& file) { file.stored_outside("/VTKHDF/PointData/p", "../secret", 5); }),
                 {"/VTKHDF/PointData/p", "../secret", "only files below"});
}

TEST_F(HostileHdf5, DataPutTogetherOfOtherFilesIsAnError) {
    expect_error(vtkhdf([](Hdf5Writer& file) { file.virtual_data("/VTKHDF/PointData/p", "../other.h5", "/p", 5); }),
                 {"/VTKHDF/PointData/p", "../other.h5", "only files below"});
}

TEST_F(HostileHdf5, AGroupThatContainsItselfIsAnError) {
    expect_error(vtkhdf([](Hdf5Writer& file) { file.hard_link("/VTKHDF", "/VTKHDF/again"); }),
                 {"/VTKHDF/again", "contains itself"});
}

TEST_F(HostileHdf5, ASoundFileWithLinksInItsFolderIsRead) {
    {
        std::filesystem::create_directories(folder_.file("case"));
        Hdf5Writer other(folder_.file("case/other.h5"));
        other.data<double>("/p", {1, 2, 3, 4, 5}, {5});
    }
    const auto result =
        read(vtkhdf([](Hdf5Writer& file) { file.external_link("/VTKHDF/PointData/p", "other.h5", "/p"); }));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.point_fields.at(0).values.at(4), 5);
    EXPECT_EQ(result->info.files.size(), 2U) << "both are protected from being overwritten";
}

TEST_F(HostileFile, AnAdfFileThatIsCutShortIsAnError) {
    const std::string whole = content_of((source_folder() / "data/cgns/wall_distance_adf.cgns").string());
    for (const std::size_t length : {whole.size() / 4, whole.size() / 2, whole.size() * 3 / 4, whole.size() - 4096})
        expect_error(folder_.write("cut.cgns", whole.substr(0, length)), {"cut short"});
}

using HostileXdmf = HostileFile;

TEST_F(HostileXdmf, EntitiesThatGrowAreAnError) {
    std::string text =
        "<?xml version=\"1.0\"?>\n<!DOCTYPE Xdmf [<!ENTITY a \"" + std::string(3000, 'x') + "\">]>\n<Xdmf><Domain>";
    for (int i = 0; i < 10000; ++i) text += "&a;";
    expect_error(folder_.write("a.xdmf", text + "</Domain></Xdmf>"), {"entities"});
}

TEST_F(HostileXdmf, ReferencesAreWrittenAsPaths) {
    const auto referring = [&](const std::string& query) {
        return folder_.write("a.xdmf", "<Xdmf><Domain><Grid Reference='" + query + "'/></Domain></Xdmf>");
    };
    for (const char* query : {"//*[//*[//*[//*]]]", "//*//*//*//*//Grid", "//a|//a|//a|//a|//a|//a|//a|//a|//*"})
        expect_error(referring(query), {"refers to nothing"});
}

TEST_F(HostileXdmf, AMillionReferencesEnd) {
    std::string text = "<Xdmf><Domain>";
    for (int i = 0; i < 100000; ++i) text += "<Grid Reference='//Grid[" + std::to_string(i + 2) + "0000000]'/>";
    EXPECT_NE(message_of(folder_.write("a.xdmf", text + "</Domain></Xdmf>")), "read");
}

} // namespace
} // namespace isotet::test

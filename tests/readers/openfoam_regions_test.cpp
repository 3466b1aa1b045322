// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// OpenFOAM cases of several regions: the mesh that they were split from, names that regions and zones share, fields of one
// region alone, and files that are no fields.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/read.hpp>

#include "readers/foam_sample.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

double sum_of(const std::array<double, 3>& p) { return p[0] + p[1] + p[2]; }

/// The files of a case as those of a region.
FoamFiles in_region(const FoamFiles& files, const std::string& region) {
    FoamFiles out;
    for (const auto& [name, content] : files) {
        std::size_t slash = name.find('/');
        if (name.starts_with("processor")) slash = name.find('/', slash + 1);
        out[slash == std::string::npos ? name : name.substr(0, slash + 1) + region + name.substr(slash)] = content;
    }
    return out;
}

bool mentions(const std::vector<std::string>& notes, const std::string& what) {
    return std::ranges::any_of(notes, [&](const std::string& note) { return note.find(what) != std::string::npos; });
}

class OpenfoamRegions : public testing::Test {
protected:
    void SetUp() override {
        for (FoamBox* box : {&base_, &left_, &right_}) {
            box->zones = {{"left", {}}, {"right", {}}};
            for (std::size_t cell = 0; cell < box->centres.size(); ++cell)
                box->zones[box == &right_].cells.push_back(static_cast<std::int64_t>(cell));
        }
    }

    /// Base mesh, left and right. The cells' numbers tell them apart: 27, 8 and 64.
    FoamFiles files(int processors = 0) const {
        FoamFiles all = foam_case(base_, sum_of, {}, processors);
        all.merge(in_region(foam_case(left_, sum_of, {}, processors), "left"));
        all.merge(in_region(foam_case(right_, sum_of, {}, processors), "right"));
        return all;
    }

    Result<ReadResult> read_blocks(const FoamFiles& files, const std::vector<std::string>& blocks) const {
        const TemporaryFolder folder;
        for (const auto& [name, content] : files) folder.write(name, content);
        ReadOptions options;
        options.step = 1;
        options.blocks = blocks;
        return read(folder.file(""), options);
    }
    std::size_t cells_of(const FoamFiles& files, const std::vector<std::string>& blocks) const {
        const auto result = read_blocks(files, blocks);
        EXPECT_TRUE(result) << result.error().message;
        return result ? result->grid.cells.count() : 0;
    }

    static bool none(int, int, int) { return false; }
    FoamBox base_ = foam_box(3, none), left_ = foam_box(2, none), right_ = foam_box(4, none);
};

TEST_F(OpenfoamRegions, AreReadInPlaceOfTheMeshThatTheyWereSplitFrom) {
    for (const int processors : {0, 2}) {
        const FoamFiles plain = files(processors);
        for (const FoamFiles& written : {plain, processors ? collated(plain, {2}, false) : plain}) {
            const auto all = read_blocks(written, {});
            ASSERT_TRUE(all) << all.error().message;
            EXPECT_EQ(all->grid.cells.count(), 64u) << "the cells of left are also in right: they count once";
            EXPECT_TRUE(mentions(all->notes, "constant/polyMesh")) << "what is left out";
            EXPECT_TRUE(mentions(all->notes, "--block polyMesh")) << "how to get it";
            EXPECT_EQ(cells_of(written, {"left"}), 8u);
            EXPECT_EQ(cells_of(written, {"right"}), 64u);
            for (const char* base : {"polyMesh", "1"}) EXPECT_EQ(cells_of(written, {base}), 27u);
            const auto left = read_blocks(written, {"left"});
            EXPECT_FALSE(mentions(left->notes, "--block polyMesh")) << "a choice was made";
        }
    }
}

TEST_F(OpenfoamRegions, HaveNamesThatMeanNoZone) {
    const FoamFiles all = files();
    EXPECT_EQ(cells_of(all, {"left/left"}), 8u);
    EXPECT_EQ(cells_of(all, {"polyMesh/left"}), 27u);
    EXPECT_EQ(cells_of(all, {"left", "polyMesh/left"}), 27u);
    const auto result = read_blocks(all, {"left"});
    ASSERT_TRUE(result);
    std::vector<std::string> names;
    for (const BlockInfo& block : result->info.blocks) names.push_back(block.name);
    EXPECT_EQ(names,
              (std::vector<std::string>{"polyMesh", "left", "right", "polyMesh/left", "left/left", "right/right"}))
        << "zones without cells are not listed";
}

TEST_F(OpenfoamRegions, AreLookedForWithoutTheBaseMesh) {
    FoamFiles all = in_region(foam_case(left_, sum_of, {}), "left");
    const auto one = read_blocks(all, {});
    ASSERT_TRUE(one) << one.error().message;
    EXPECT_EQ(one->grid.cells.count(), 8u);
    EXPECT_FALSE(mentions(one->notes, "left out"));
    all.merge(foam_case(base_, sum_of, {}));
    EXPECT_EQ(cells_of(all, {}), 8u) << "one region beside the base mesh";
}

TEST_F(OpenfoamRegions, HaveFieldsOfTheirOwn) {
    FoamFiles all = files();
    for (const char* time : {"0/", "0.5/"}) {
        for (const char* field : {"T", "U"}) all.erase(std::string(time) + field);
        all.erase(std::string(time) + "right/U");
    }
    const auto result = read_blocks(all, {});
    ASSERT_TRUE(result) << result.error().message;
    ASSERT_EQ(result->grid.cell_fields.size(), 2u);
    for (const Field& field : result->grid.cell_fields) {
        EXPECT_EQ(field.values.tuples(), 64u);
        std::size_t without = 0;
        for (std::size_t cell = 0; cell < 64; ++cell) without += std::isnan(field.values.at(cell, 0));
        EXPECT_EQ(without, field.name == "U" ? 56u : 0u) << field.name;
    }
}

TEST(OpenfoamFields, ThatCannotBeReadAreToldWithTheReason) {
    const TemporaryFolder folder, other;
    const FoamBox box = foam_box(2, [](int, int, int) { return false; });
    const FoamFiles files = foam_case(box, sum_of, {});
    for (const auto& [name, content] : files) folder.write(name, content);
    std::filesystem::create_symlink(other.write("p", files.at("0.5/T")), folder.file("0.5/p"));
    folder.write("0.5/k", "# restarted\n" + files.at("0.5/T"));
    folder.write("0.5/notes", "What I did today.\n");
    ReadOptions options;
    options.step = 1;
    const auto result = read(folder.file(""), options);
    ASSERT_TRUE(result) << result.error().message;
    ASSERT_EQ(result->info.left_out.size(), 2u);
    EXPECT_EQ(result->info.left_out[0].name, "k");
    EXPECT_NE(result->info.left_out[0].reason.find("does not begin with FoamFile"), std::string::npos);
    EXPECT_EQ(result->info.left_out[1].name, "p");
    EXPECT_NE(result->info.left_out[1].reason.find("`allow_outside`"), std::string::npos);
    options.point_fields = {"p"};
    const auto refused = read(folder.file(""), options);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("`allow_outside`"), std::string::npos) << refused.error().message;
    options.allow_outside = true;
    EXPECT_TRUE(read(folder.file(""), options));
}

} // namespace
} // namespace isotet::test

// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Files that pages download, by scripts in place of isotet.
#include <gtest/gtest.h>

#include <filesystem>
#include <future>
#include <string>
#include <thread>

#include "support/temporary_folder.hpp"
#include "view/server/download.hpp"

namespace isotet::test {
namespace {

using namespace view;

class DownloadsTest : public testing::Test {
protected:
    /// Downloads of a program that runs `commands`, whose last word is the path to write.
    std::unique_ptr<Downloads> by(const std::string& commands) {
        const std::string tell = "for path; do :; done; echo \"$path\" > '" + scripts_.file("path") + "'; ";
        return std::make_unique<Downloads>(scripts_.write_script("isotet", tell + commands));
    }
    static SaveRequest request(const std::string& name) {
        SaveRequest request;
        request.kind = SaveKind::surface;
        request.name = name;
        return request;
    }
    static Result<Download> written(Downloads& downloads, std::uint64_t page, const SaveRequest& request) {
        std::promise<Result<Download>> promise;
        const auto tell = [&](Result<Download> done) { promise.set_value(std::move(done)); };
        const Result<void> started = downloads.start(page, request, "grid.vtu", {}, tell);
        if (!started) return started.error();
        return promise.get_future().get();
    }
    std::string path() const {
        std::ifstream file(scripts_.file("path"));
        std::string line;
        std::getline(file, line);
        return line;
    }
    TemporaryFolder scripts_;
};

TEST_F(DownloadsTest, SendsAFileInPartsAndLeavesNoName) {
    const auto downloads = by("head -c 5000000 /dev/zero > \"$path\"");
    const auto file = written(*downloads, 1, request("a.stl"));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->name, "a.stl");
    EXPECT_EQ(file->bytes, 5'000'000U);
    EXPECT_FALSE(std::filesystem::exists(path()));
    EXPECT_TRUE(downloads->next_part(2).empty()) << "of another page";
    EXPECT_EQ(downloads->next_part(1).size(), Downloads::part_bytes);
    EXPECT_EQ(downloads->next_part(1).size(), Downloads::part_bytes);
    EXPECT_EQ(downloads->next_part(1).size(), 5'000'000 - 2 * Downloads::part_bytes);
    EXPECT_TRUE(downloads->next_part(1).empty());
}

TEST_F(DownloadsTest, RefusesNamesThatAreNoneAndTellsWhatFailed) {
    const auto downloads = by("echo 'isotet: the disk is full' >&2; exit 5");
    EXPECT_FALSE(written(*downloads, 1, request("../a.stl")));
    EXPECT_FALSE(written(*downloads, 1, request("a.png")));
    const auto failed = written(*downloads, 1, request("a.stl"));
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().message, "isotet: the disk is full");
    EXPECT_TRUE(downloads->next_part(1).empty());
}

TEST_F(DownloadsTest, APageThatGoesTakesItsFileWithIt) {
    const auto downloads = by("printf solid > \"$path\"");
    ASSERT_TRUE(written(*downloads, 1, request("a.stl")));
    downloads->forget(1);
    EXPECT_TRUE(downloads->next_part(1).empty());
}

TEST_F(DownloadsTest, APageThatGoesEndsTheProgram) {
    const auto downloads = by("printf half > \"$path\"; echo > '" + scripts_.file("begun") + "'; exec sleep 1000");
    std::promise<Result<Download>> promise;
    ASSERT_TRUE(downloads->start(1, request("a.stl"), "grid.vtu", {},
                                 [&](Result<Download> done) { promise.set_value(std::move(done)); }));
    while (!std::filesystem::exists(scripts_.file("begun"))) std::this_thread::yield();
    downloads->forget(1);
    EXPECT_FALSE(promise.get_future().get());
}

TEST_F(DownloadsTest, TheFolderGoesWithThem) {
    auto downloads = by("printf solid > \"$path\"");
    ASSERT_TRUE(written(*downloads, 1, request("a.stl")));
    const auto folder = std::filesystem::path(path()).parent_path().parent_path();
    EXPECT_TRUE(std::filesystem::exists(folder));
    EXPECT_EQ(std::filesystem::status(folder).permissions(), std::filesystem::perms::owner_all);
    downloads.reset();
    EXPECT_FALSE(std::filesystem::exists(folder));
}

} // namespace
} // namespace isotet::test

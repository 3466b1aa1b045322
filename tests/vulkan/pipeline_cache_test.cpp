// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Compiled pipelines are kept between runs, and no state of their file does any harm.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "base/system/cache_folder.hpp"
#include "support/temporary_folder.hpp"
#include "vulkan/pipeline_cache.hpp"
#include "vulkan/software_device.hpp"

namespace isotet::test {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t head_bytes = 24;

class CompiledPipelines : public testing::Test {
protected:
    /// Opens and closes a device; the bytes that were read from the cache's file.
    std::size_t open() {
        vulkan::Settings settings = watched();
        settings.cache_folder = folder();
        const auto context = open_software(settings);
        EXPECT_EQ(context->notices(), std::vector<std::string>());
        return context->pipeline_cache().bytes_read();
    }

    fs::path folder() const { return temporary_.file("cache/isotet"); }

    fs::path file() const {
        const fs::directory_iterator files(folder());
        EXPECT_EQ(std::distance(begin(files), end(files)), 1) << "one file, and nothing beside it";
        return fs::directory_iterator(folder())->path();
    }

    std::string content() const {
        std::ifstream in(file(), std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }

    void replace(const std::string& bytes) const {
        const fs::path path = file();
        std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
    }

    TemporaryFolder temporary_;
};

TEST_F(CompiledPipelines, AreReadByTheNextDevice) {
    EXPECT_EQ(open(), 0u);
    const std::size_t size = fs::file_size(file());
    EXPECT_GT(size, head_bytes);
    EXPECT_EQ(open(), size - head_bytes);
}

TEST_F(CompiledPipelines, AreNotReadFromABrokenFile) {
    open();
    const std::string whole = content();
    for (const std::size_t length :
         {std::size_t{0}, std::size_t{7}, std::size_t{24}, whole.size() / 2, whole.size() - 1}) {
        replace(whole.substr(0, length));
        EXPECT_EQ(open(), 0u) << "cut to " << length;
        EXPECT_EQ(content().size(), whole.size()) << "written anew";
    }
    for (const std::size_t place :
         {std::size_t{0}, std::size_t{9}, std::size_t{16}, std::size_t{24}, whole.size() - 1}) {
        std::string broken = whole;
        broken[place] = static_cast<char>(broken[place] ^ 0x10);
        replace(broken);
        EXPECT_EQ(open(), 0u) << "byte " << place;
    }
    replace(whole + "x");
    EXPECT_EQ(open(), 0u);
    replace(whole);
    EXPECT_EQ(open(), whole.size() - head_bytes);
}

// Drivers and builds change: their files must not gather for ever.
TEST_F(CompiledPipelines, OfOtherBuildsGoWhenThereAreMany) {
    open();
    const fs::path of_this_build = file();
    const auto add = [&](const std::string& name, int hours_old) {
        std::ofstream(folder() / name) << "x";
        fs::last_write_time(folder() / name, fs::file_time_type::clock::now() - std::chrono::hours(hours_old));
        return folder() / name;
    };
    std::vector<fs::path> others;
    for (int i = 0; i < 12; ++i)
        others.push_back(add("pipelines-00000000000000" + std::to_string(10 + i) + ".bin", 1 + i));
    const std::string tested(vulkan::PipelineCache::tested_suffix);
    for (const fs::path& other : others) add(other.filename().string() + tested, 50);
    const fs::path note = add(of_this_build.filename().string() + tested, 50);
    const fs::path killed = add("pipelines-0000000000000000.bin.123", 2),
                   writing = add("pipelines-0000000000000000.bin.456", 0);
    const fs::path foreign = add("notes.txt", 1000);
    fs::last_write_time(of_this_build, fs::file_time_type::clock::now() - std::chrono::hours(100));
    EXPECT_GT(open(), 0u);
    for (std::size_t i = 0; i < others.size(); ++i) {
        EXPECT_EQ(fs::exists(others[i]), i + 1 < vulkan::PipelineCache::max_files)
            << "file " << i << " of others, newest first";
        EXPECT_EQ(fs::exists(fs::path(others[i]).concat(tested)), fs::exists(others[i])) << "its note";
    }
    EXPECT_TRUE(fs::exists(note)) << "what the device was found to do right stays, however long ago";
    EXPECT_TRUE(fs::exists(of_this_build)) << "it is the newest now";
    EXPECT_FALSE(fs::exists(killed));
    EXPECT_TRUE(fs::exists(writing)) << "somebody may be at it";
    EXPECT_TRUE(fs::exists(foreign));
}

TEST_F(CompiledPipelines, DoWithoutAFolder) {
    fs::create_directories(folder().parent_path());
    std::ofstream(folder()) << "a file where the folder should be";
    EXPECT_EQ(open(), 0u);
    EXPECT_TRUE(fs::is_regular_file(folder()));
}

TEST_F(CompiledPipelines, DoWithoutAFileOfThatName) {
    open();
    const fs::path path = file();
    fs::remove(path);
    fs::create_directories(path / "in the way");
    EXPECT_EQ(open(), 0u);
    EXPECT_EQ(file(), path);
}

TEST(PipelineCacheFolder, FollowsTheXdgSpecification) {
    const auto folder_with = [](const char* cache, const char* home) {
        cache ? setenv("XDG_CACHE_HOME", cache, 1) : unsetenv("XDG_CACHE_HOME");
        home ? setenv("HOME", home, 1) : unsetenv("HOME");
        return core::cache_folder().string();
    };
    EXPECT_EQ(folder_with("/some/cache", "/home/me"), "/some/cache/isotet");
    EXPECT_EQ(folder_with(nullptr, "/home/me"), "/home/me/.cache/isotet");
    EXPECT_EQ(folder_with("", "/home/me"), "/home/me/.cache/isotet");
    EXPECT_EQ(folder_with("relative", "/home/me"), "/home/me/.cache/isotet");
    EXPECT_EQ(folder_with(nullptr, nullptr), "");
}

} // namespace
} // namespace isotet::test

// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What a page of one file has, without a command line. Pages in browsers: export_test.py, grid_page_test.py.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <variant>

#include "jobs/listener.hpp"
#include "support/temporary_folder.hpp"
#include "view/export/export_page.hpp"

namespace isotet::test {
namespace {

view::ExportJob job_of(const std::string& out) {
    view::ExportJob job;
    job.grid.file = "make:kuhn:8:sphere,gyroid";
    job.field.name = "sphere";
    job.out = out;
    job.as = view::PageContent::surfaces;
    return job;
}

TEST(ExportPage, TellsWhatIsInThePage) {
    const TemporaryFolder folder;
    const std::string page = folder.file("page.html");
    view::ExportJob job = job_of(page);
    job.isovalues = {0.1, 0.5};
    Listener listener;
    const auto numbers = view::export_page(job, listener);
    ASSERT_TRUE(numbers) << numbers.error().message;
    const auto* surfaces = std::get_if<view::ExportedSurfaces>(&numbers->content);
    ASSERT_TRUE(surfaces);
    EXPECT_EQ(surfaces->isovalues, job.isovalues);
    EXPECT_EQ(surfaces->steps, 1u);
    EXPECT_GT(surfaces->triangles, 100u);
    EXPECT_EQ(std::filesystem::file_size(page), numbers->bytes);
}

TEST(ExportPage, NamesWhatIsWrong) {
    const TemporaryFolder folder;
    const std::string page = folder.file("page.html");
    Listener listener;
    view::ExportJob job = job_of(page);
    job.between = {0.5, 0.1};
    EXPECT_NE(view::export_page(job, listener).error().message.find("`between`"), std::string::npos);
    job = job_of(page);
    job.out += ".txt";
    EXPECT_NE(view::export_page(job, listener).error().message.find(".html"), std::string::npos);
    job = job_of(page);
    job.field.name = "none of these";
    EXPECT_EQ(view::export_page(job, listener).error().code, ErrorCode::invalid_argument);
    job = job_of(page);
    job.max_size = 1000;
    job.isovalues = {0.1};
    EXPECT_EQ(view::export_page(job, listener).error().code, ErrorCode::invalid_argument);
    EXPECT_FALSE(std::filesystem::exists(page));
}

} // namespace
} // namespace isotet::test

// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The next step is read while a step is extracted or drawn, and nothing else shows it.
#include <isotet/jobs/draw_files.hpp>
#include <isotet/jobs/extract_files.hpp>

#include <algorithm>
#include <filesystem>
#include <string_view>

#include <poll.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include <isotet/make.hpp>
#include <isotet/write.hpp>

#include "jobs/listener.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::jobs {
namespace {

using test::Listener;

/// Whether a file was read and closed.
class Watch {
public:
    Watch() : watch_(inotify_init1(IN_CLOEXEC)) {}
    Watch(const Watch&) = delete;
    Watch& operator=(const Watch&) = delete;
    ~Watch() { ::close(watch_); }

    void begin(const std::string& file) { ASSERT_GE(inotify_add_watch(watch_, file.c_str(), IN_CLOSE_NOWRITE), 0); }
    bool wait() const {
        constexpr int milliseconds = 30'000; // until it is taken for never
        pollfd ready{watch_, POLLIN, 0};
        return ::poll(&ready, 1, milliseconds) == 1;
    }

private:
    int watch_;
};

/// From `first` on watches a file, and waits at `second` until it was read.
class Waits : public Listener {
public:
    Waits(std::string file, std::string_view first, std::string_view second)
        : file_(std::move(file)), first_(first), second_(second) {}

    void detail(const std::string& sentence) override {
        Listener::detail(sentence);
        if (!watches_ && sentence.find(first_) != sentence.npos) {
            watches_ = true;
            watch_.begin(file_);
        } else if (watches_ && !waited_ && sentence.find(second_) != sentence.npos) {
            waited_ = true;
            was_read = watch_.wait();
        }
    }
    bool was_read = false;

private:
    Watch watch_;
    std::string file_;
    std::string_view first_, second_;
    bool watches_ = false, waited_ = false;
};

class Stops : public Listener {
public:
    explicit Stops(std::string_view at) : at_(at) {}

    void detail(const std::string& sentence) override {
        if (sentence.find(at_) != sentence.npos) stop = true;
    }

private:
    std::string_view at_;
};

class StepsThatAreStreamed : public testing::Test {
protected:
    StepsThatAreStreamed() {
        std::string entries;
        for (const char step : {'0', '1', '2'}) {
            const std::string name = std::string("step") + step + ".vtu";
            Grid grid = make_grid({.shape = "shuffled", .side = 9, .fields = {"gyroid"}}).value();
            std::vector<float> values(grid.points.tuples());
            for (std::size_t i = 0; i < values.size(); ++i)
                values[i] =
                    static_cast<float>(grid.point_fields[0].values.at(i)) + 0.1F * static_cast<float>(step - '0');
            grid.point_fields[0].values = Array::own(std::move(values));
            EXPECT_TRUE(write_grid(grid, folder.file(name)));
            entries += std::string("<DataSet timestep=\"") + step + "\" file=\"" + name + "\"/>";
        }
        series =
            folder.write("run.pvd", "<VTKFile type=\"Collection\"><Collection>" + entries + "</Collection></VTKFile>");
    }

    ExtractJob extraction(const std::string& name) const {
        ExtractJob job;
        job.grid.file = series;
        job.out = folder.file(name + "{step}.vtp");
        job.field.name = "gyroid";
        job.isovalues = {0.1};
        job.all_steps = true;
        return job;
    }
    DrawJob drawing(const std::string& name) const {
        DrawJob job;
        job.grid.file = series;
        job.out = folder.file(name + "{frame}.png");
        job.field.name = "gyroid";
        job.isovalues = {0.1};
        job.all_steps = true;
        job.picture.width = 160;
        job.picture.height = 120;
        return job;
    }
    void break_step(const char* name) const { std::filesystem::resize_file(folder.file(name), 20'000); }

    const test::TemporaryFolder folder;
    std::string series;
};

TEST_F(StepsThatAreStreamed, AreReadWhileTheStepBeforeIsExtracted) {
    Waits listener(folder.file("step1.vtu"), "reading step 0", "extracting");
    ASSERT_TRUE(extract_files(extraction("a"), listener));
    EXPECT_TRUE(listener.was_read);
}

TEST_F(StepsThatAreStreamed, AreReadWhileTheStepBeforeIsDrawn) {
    Waits listener(folder.file("step1.vtu"), "cells were kept", "picture 2 of 3");
    ASSERT_TRUE(draw_files(drawing("a"), listener));
    EXPECT_TRUE(listener.was_read);
}

/// What was said, without the names of outputs.
std::vector<std::string> told(const std::vector<std::string>& said) {
    std::vector<std::string> all;
    for (const std::string& sentence : said)
        if (sentence.find(".vtp") == sentence.npos && sentence.find(".png") == sentence.npos) all.push_back(sentence);
    return all;
}

TEST_F(StepsThatAreStreamed, GiveTheSameOneAfterAnother) {
    Listener one(1), ahead;
    ASSERT_TRUE(extract_files(extraction("a"), one));
    ASSERT_TRUE(extract_files(extraction("b"), ahead));
    EXPECT_EQ(told(one.details), told(ahead.details));
    EXPECT_EQ(told(one.noted), told(ahead.noted));
    for (const char* ending : {"0.vtp", "1.vtp", "2.vtp"})
        EXPECT_TRUE(test::content_of(folder.file("a") + ending) == test::content_of(folder.file("b") + ending));
    Listener one_drawn(1), drawn_ahead;
    ASSERT_TRUE(draw_files(drawing("a"), one_drawn));
    ASSERT_TRUE(draw_files(drawing("b"), drawn_ahead));
    EXPECT_EQ(told(one_drawn.details), told(drawn_ahead.details));
    EXPECT_EQ(told(one_drawn.noted), told(drawn_ahead.noted));
    for (const char* ending : {"1.png", "2.png", "3.png"})
        EXPECT_TRUE(test::content_of(folder.file("a") + ending) == test::content_of(folder.file("b") + ending));
}

TEST_F(StepsThatAreStreamed, TellOfErrorsInTheirTurn) {
    break_step("step1.vtu");
    Listener listener;
    const auto numbers = extract_files(extraction("a"), listener);
    ASSERT_TRUE(numbers) << numbers.error().message;
    ASSERT_EQ(numbers->broken_steps.size(), 1u);
    EXPECT_EQ(numbers->broken_steps[0].step, 1u);
    EXPECT_EQ(numbers->surfaces.size(), 2u);
    const auto drawn = draw_files(drawing("a"), listener);
    ASSERT_TRUE(drawn) << drawn.error().message;
    EXPECT_EQ(drawn->pictures.pictures, 2u);
}

TEST_F(StepsThatAreStreamed, AreGivenUpWhereTheJobIsCancelled) {
    Stops extracting("extracting"), drawing_step("picture 2 of 3");
    EXPECT_EQ(extract_files(extraction("a"), extracting).error().code, ErrorCode::cancelled);
    EXPECT_EQ(draw_files(drawing("a"), drawing_step).error().code, ErrorCode::cancelled);
}

} // namespace
} // namespace isotet::jobs

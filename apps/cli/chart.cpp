// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "text.hpp"

namespace isotet::cli {

namespace {

constexpr double width = 900, height = 560;
constexpr double left = 90, top = 64, plot_width = 560, plot_height = 420;
constexpr double label_height = 16;
constexpr std::array dashes{"", " stroke-dasharray=\"2 3\"", " stroke-dasharray=\"9 3\""}; // when colours begin anew
constexpr std::array colors{
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9",
    "#000000", "#7f7f7f", "#8c564b", "#999933", "#4b0082", "#800000"}; // those of Okabe and Ito, and four more

std::string xml_text(std::string_view text) {
    std::string out;
    for (const char c : printable(text)) {
        switch (c) {
        case '&': out += "&amp;"; break;
        case '<': out += "&lt;"; break;
        case '>': out += "&gt;"; break;
        default: out += c;
        }
    }
    return out;
}

std::string text_at(double x, double y, const std::string& text, const char* anchor, const char* color = "#222222",
                    int size = 12) {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"{}\" fill=\"{}\">{}</text>\n", x,
                       y, anchor, size, color, xml_text(text));
}

std::string line_between(double x1, double y1, double x2, double y2) {
    return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#dddddd\"/>\n", x1, y1,
                       x2, y2);
}

/// "100", "10 k", "1 M".
std::string decade_text(double value) {
    constexpr std::array<const char*, 5> units{"", " k", " M", " G", " T"};
    if (value < 0.9) return fmt::format("{:g}", value);
    std::size_t unit = 0;
    while (value >= 999.9 && unit + 1 < units.size()) {
        value /= 1000;
        ++unit;
    }
    return fmt::format("{:g}{}", value, units[unit]);
}

/// Whole decades around what is to be shown.
class LogAxis {
public:
    LogAxis(double lowest, double highest, double start, double length)
        : first_(std::floor(std::log10(lowest) + 1e-9)),
          last_(std::max(std::ceil(std::log10(highest) - 1e-9), first_ + 1)),
          start_(start),
          length_(length) {}

    double place(double value) const { return start_ + length_ * (std::log10(value) - first_) / (last_ - first_); }
    std::vector<double> decades() const {
        std::vector<double> values;
        for (double power = first_; power <= last_; ++power) values.push_back(std::pow(10.0, power));
        return values;
    }

private:
    double first_, last_, start_, length_;
};

bool can_be_shown(const ChartPoint& point) {
    return std::isfinite(point.x) && std::isfinite(point.y) && point.x > 0 && point.y > 0;
}

/// Places for names beside the ends of their lines, moved apart where they would touch.
std::vector<double> label_places(const std::vector<double>& wanted) {
    std::vector<std::size_t> order(wanted.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return wanted[i]; });
    std::vector<double> places(wanted.size());
    double free_from = top;
    for (const std::size_t i : order) {
        places[i] = std::max(wanted[i], free_from);
        free_from = places[i] + label_height;
    }
    double free_to = height - label_height; // and back up where they leave the picture
    for (auto i = order.rbegin(); i != order.rend(); ++i) {
        places[*i] = std::min(places[*i], free_to);
        free_to = places[*i] - label_height;
    }
    return places;
}

} // namespace

std::string Chart::svg() const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    ChartPoint lowest{infinity, infinity}, highest{0, 0};
    std::vector<ChartLine> shown = lines;
    for (ChartLine& line : shown) {
        std::erase_if(line.points, [](const ChartPoint& point) { return !can_be_shown(point); });
        for (const ChartPoint& point : line.points) {
            lowest = {std::min(lowest.x, point.x), std::min(lowest.y, point.y)};
            highest = {std::max(highest.x, point.x), std::max(highest.y, point.y)};
        }
    }
    std::erase_if(shown, [](const ChartLine& line) { return line.points.empty(); });
    if (shown.empty()) lowest = highest = {1, 1};

    const LogAxis x(lowest.x, highest.x, left, plot_width), y(lowest.y, highest.y, top + plot_height, -plot_height);
    std::string out =
        fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
                    "font-family=\"sans-serif\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
                    width, height);
    out += text_at(left, 24, title, "start", "#222222", 16) + text_at(left, 44, subtitle, "start", "#555555");
    for (const double value : x.decades()) {
        out += line_between(x.place(value), top, x.place(value), top + plot_height);
        out += text_at(x.place(value), top + plot_height + 20, decade_text(value), "middle");
    }
    for (const double value : y.decades()) {
        out += line_between(left, y.place(value), left + plot_width, y.place(value));
        out += text_at(left - 8, y.place(value) + 4, decade_text(value), "end");
    }
    out += text_at(left + plot_width / 2, height - 20, x_title, "middle");
    out += fmt::format("<g transform=\"rotate(-90 24 {0:.1f})\">{1}</g>\n", top + plot_height / 2,
                       text_at(24, top + plot_height / 2, y_title, "middle"));

    std::vector<double> ends;
    for (const ChartLine& line : shown) ends.push_back(y.place(line.points.back().y) + 4);
    const std::vector<double> labels = label_places(ends);
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const char* const color = colors[i % colors.size()];
        std::string path;
        for (const ChartPoint& point : shown[i].points)
            path += fmt::format("{:.1f},{:.1f} ", x.place(point.x), y.place(point.y));
        path.pop_back();
        out += fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"{}/>\n", path, color,
                           shown[i].dashed ? " stroke-dasharray=\"6 4\"" : dashes[i / colors.size() % dashes.size()]);
        for (const ChartPoint& point : shown[i].points)
            out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>\n", x.place(point.x),
                               y.place(point.y), color);
        out += text_at(left + plot_width + 12, labels[i], shown[i].name, "start", color);
    }
    return out + "</svg>\n";
}

} // namespace isotet::cli

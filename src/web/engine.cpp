// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// isotet as WebAssembly for other pages (js/isotet.js): one grid, from a file or from arrays, and its isosurfaces as
// arrays in the module's memory. JavaScript calls with a JSON text, and is given one.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <isotet/fields.hpp>
#include <isotet/contour.hpp>
#include <isotet/packed_file.hpp>

#include "base/buffer.hpp"
#include "engine_files.hpp"
#include "page.hpp"
#include "view/json.hpp"
#include "webgpu/card.hpp"

namespace isotet::web {

using view::find;
using view::Json;

namespace {

/// What is contoured, and what the surface has.
struct Wish {
    std::string field;
    std::vector<std::string> carried;
    Normals normals = Normals::none;
    std::size_t step = 0;
    bool once = false; ///< no other isovalue will be asked for: nothing is packed
    friend bool operator==(const Wish&, const Wish&) = default;
};

class Engine {
public:
    Result<Json> open(const Json& message);
    Result<Json> take(const Json& message);
    Result<Json> contour(const Json& message);
    Result<Json> range(const Json& message);
    /// Memory for an array of a message take(), until then.
    void* room_for_array(std::size_t bytes);

private:
    Result<void> set(const Wish& wish);
    Result<void> go_to_step(std::size_t step);
    Result<ContourInput> input_of(const Wish& wish) const;
    Result<Array> given_array(const Json& message, std::string_view key, std::size_t components) const;
    Json description() const;

    std::vector<std::shared_ptr<core::Buffer<std::byte>>> given_;
    std::string path_; ///< empty: the grid was given in arrays
    Grid grid_;        ///< empty where `file_` has it
    std::optional<PackedFile> file_;
    std::vector<double> times_;
    std::size_t step_ = 0; ///< that grid_ is
    std::vector<std::string> notes_;
    std::optional<Contour> contour_;
    Wish wish_; ///< that contour_ is set to
    ContourResult surfaces_;
};

Error bad_message(std::string_view rule) { return {ErrorCode::invalid_argument, std::string(rule)}; }

Run telling_run() {
    Run run{1, {}};
    run.progress.report = [](std::string_view step, double fraction) {
        say_text(view::text_of({{"progress", {step, fraction}}}));
    };
    return run;
}

std::string word_of(const Json& message, std::string_view key) {
    const Json* value = find(message, key);
    const std::string* word = value ? view::text(*value) : nullptr;
    return word ? *word : std::string();
}

std::vector<std::string> words_of(const Json& message, std::string_view key) {
    std::vector<std::string> words;
    if (const Json* values = find(message, key); values && values->is_array())
        for (const Json& value : *values)
            if (const std::string* word = view::text(value)) words.push_back(*word);
    return words;
}

std::optional<ScalarType> scalar_type(std::string_view name) {
    for (int i = 0; i <= static_cast<int>(ScalarType::float64); ++i)
        if (const auto type = static_cast<ScalarType>(i); name_of(type) == name) return type;
    return std::nullopt;
}

/// Where an array lies: JavaScript makes a view of it.
Json place_of(const Array& array) {
    return {{"type", name_of(array.type())},
            {"at", reinterpret_cast<std::uintptr_t>(array.data())},
            {"count", array.size()}};
}

Json fields_json(const std::vector<Field>& fields, bool cell) {
    Json list = Json::array();
    for (const Field& field : fields)
        list.push_back({{"name", field.name}, {"components", field.values.components()}, {"cell", cell}});
    return list;
}

void* Engine::room_for_array(std::size_t bytes) {
    given_.push_back(std::make_shared<core::Buffer<std::byte>>(bytes));
    return given_.back()->data();
}

Json Engine::description() const {
    Json fields = fields_json(grid_.point_fields, false);
    for (Json& field : fields_json(grid_.cell_fields, true)) fields.push_back(std::move(field));
    std::uint64_t points = grid_.points.tuples(), cells = grid_.cells.count();
    if (file_) {
        points = file_->info().user_points;
        cells = file_->info().user_cells;
        for (const PackedFieldInfo& field : file_->info().fields)
            if (field.step == 0) fields.push_back({{"name", field.report.name}, {"components", 1}, {"cell", false}});
    }
    return {{"points", points}, {"cells", cells}, {"fields", std::move(fields)}, {"times", times_}, {"notes", notes_}};
}

Result<Json> Engine::open(const Json& message) {
    path_ = word_of(message, "path");
    if (PackedFile::is_one(path_)) {
        Result<PackedFile> file = PackedFile::open(path_);
        if (!file) return file.error();
        file_.emplace(*std::move(file));
        times_ = file_->info().times;
        return description();
    }
    Result<ReadResult> read = read_grid_file(path_, {}, telling_run());
    if (!read) return read.error();
    grid_ = std::move(read->grid);
    times_ = std::move(read->info.times);
    notes_ = std::move(read->notes);
    step_ = read->step;
    return description();
}

Result<Array> Engine::given_array(const Json& message, std::string_view key, std::size_t components) const {
    const Json* told = find(message, key);
    if (!told) return Array{};
    const auto type = scalar_type(word_of(*told, "type"));
    const Json* number = find(*told, "array");
    const auto which = number ? view::whole_number(*number) : std::nullopt;
    if (!type || !which || *which >= given_.size()) return bad_message(fmt::format("{} is no array of numbers", key));
    const auto& memory = given_[*which];
    const std::size_t count = memory->size() / size_of(*type);
    if (count % components != 0)
        return bad_message(fmt::format("{} has {} numbers, but {} belong together", key, count, components));
    return Array(*type, memory->data(), count / components, components, memory);
}

Result<Json> Engine::take(const Json& message) {
    const auto points = given_array(message, "points", 3), corners = given_array(message, "connectivity", 1),
               offsets = given_array(message, "offsets", 1), types = given_array(message, "types", 1);
    for (const auto* array : {&points, &corners, &offsets, &types})
        if (!*array) return array->error();
    grid_.points = *points;
    grid_.cells.connectivity = *corners;
    grid_.cells.offsets = *offsets;
    grid_.cells.types = *types;
    const Json* fields = find(message, "fields");
    if (!fields || !fields->is_object()) return bad_message("fields are missing");
    for (const auto& [name, told] : fields->items()) {
        const Result<Array> values = given_array(*fields, name, 1);
        if (!values) return values.error();
        grid_.point_fields.push_back({name, *values});
    }
    given_.clear();
    const Result<GridReport> report = survey(grid_, {.faces = false});
    if (!report) return report.error();
    if (report->tets == 0) return bad_message("no cell has a volume: there is nothing to contour");
    return description();
}

Result<void> Engine::go_to_step(std::size_t step) {
    if (file_ || step == step_) return {};
    if (path_.empty()) return bad_message("a grid of arrays has one time step");
    ReadOptions options;
    options.step = step;
    Result<ReadResult> read = read_grid_file(path_, options, telling_run());
    if (!read) return read.error();
    grid_ = std::move(read->grid);
    step_ = step;
    return {};
}

Result<ContourInput> Engine::input_of(const Wish& wish) const {
    ContourInput input;
    if (file_) {
        const Result<PackedGrid> packed = file_->load(wish.field, wish.step);
        if (!packed) return packed.error();
        input.packed = *packed;
        for (const std::string& name : wish.carried) {
            const Result<PackedGrid> other = file_->load(name, wish.step); // with cells of its own
            if (!other) return other.error();
            Result<Field> values = unpack_field(*other);
            if (!values) return values.error();
            input.point_fields.push_back(*std::move(values));
        }
        return input;
    }
    Result<PointField> field = find_field(grid_, wish.field);
    if (!field) return field.error();
    input.grid = grid_;
    input.field = *std::move(field);
    for (const std::string& name : wish.carried) {
        const Result<PointField> carried = find_field(grid_, name);
        if (!carried) return carried.error();
        input.point_fields.push_back({name, carried->values});
    }
    return input;
}

Result<void> Engine::set(const Wish& wish) {
    if (contour_ && wish == wish_) return {};
    if (Result<void> gone = go_to_step(wish.step); !gone) return gone.error();
    Result<ContourInput> input = input_of(wish);
    if (!input) return input.error();
    ContourOptions options;
    options.surfaces = wish.once ? 1 : 1000;
    options.engine = card_engine();
    options.normals = wish.normals;
    if (file_) options.precision = file_->info().precision;
    if (contour_) {
        if (const auto set = contour_->set(*std::move(input), options, telling_run()); !set) return set.error();
    } else {
        Result<Contour> made = Contour::create(*std::move(input), options, telling_run());
        if (!made) return made.error();
        contour_.emplace(*std::move(made));
    }
    wish_ = wish;
    return {};
}

Result<Wish> wish_of(const Json& message) {
    Wish wish{word_of(message, "field"), words_of(message, "carry")};
    const std::string normals = word_of(message, "normals");
    if (normals == "vertex") wish.normals = Normals::vertex;
    else if (!normals.empty() && normals != "none")
        return bad_message(fmt::format("normals are 'none' or 'vertex', not '{}'", normals));
    if (const Json* step = find(message, "step")) wish.step = view::whole_number(*step).value_or(0);
    wish.once = find(message, "once") != nullptr;
    return wish;
}

Result<Json> Engine::range(const Json& message) {
    const Result<Wish> wish = wish_of(message);
    if (!wish) return wish.error();
    if (Result<void> set = this->set(*wish); !set) return set.error();
    const Result<FieldReport> report = contour_->field({1, {}});
    if (!report) return report.error();
    return Json{{"lower", report->lower}, {"upper", report->upper}, {"noData", report->no_data}};
}

Result<Json> Engine::contour(const Json& message) {
    const Result<Wish> wish = wish_of(message);
    if (!wish) return wish.error();
    const Json* number = find(message, "isovalue");
    const auto isovalue = number ? view::finite_number(*number) : std::nullopt;
    if (!isovalue) return bad_message("the isovalue is no finite number");
    if (Result<void> set = this->set(*wish); !set) return set.error();
    surfaces_ = {}; // its memory is used again
    const Card::Asking asking(card());
    Result<ContourResult> made = contour_->extract(*isovalue, {1, {}});
    if (!made) return made.error();
    surfaces_ = *std::move(made);
    const Surface& surface = surfaces_.surfaces.front().surface;
    Json answer = {{"positions", place_of(surface.positions)},
                   {"triangles", place_of(surface.triangles)},
                   {"method", surfaces_.method == Method::direct ? "direct" : "clusters"},
                   {"notes", surfaces_.notes}};
    if (!surface.normals.empty()) answer["normals"] = place_of(surface.normals);
    Json fields = Json::object();
    for (const Field& field : surface.point_fields) fields[field.name] = place_of(field.values);
    answer["fields"] = std::move(fields);
    return answer;
}

Engine engine;
std::string room;

Result<Json> answer(const Json& message) {
    const std::string what = word_of(message, "do");
    if (what == "open") return engine.open(message);
    if (what == "take") return engine.take(message);
    if (what == "contour") return engine.contour(message);
    if (what == "range") return engine.range(message);
    return bad_message(fmt::format("'{}' is nothing that can be done", what));
}

} // namespace

} // namespace isotet::web

// What JavaScript calls.
extern "C" {

/// Memory for a text of so many bytes.
__attribute__((export_name("room"))) char* isotet_room(std::size_t bytes) {
    isotet::web::room.resize(bytes);
    return isotet::web::room.data();
}

/// Memory for an array, which the next message "take" names by its number.
__attribute__((export_name("array"))) void* isotet_array(std::size_t bytes) {
    return isotet::web::engine.room_for_array(bytes);
}

/// Does what the text in the room asks for.
__attribute__((export_name("call"))) void isotet_call() {
    using namespace isotet;
    const std::optional<view::Json> message = view::parse_json(web::room);
    const Result<view::Json> done =
        message ? web::answer(*message) : Result<view::Json>(web::bad_message("the message is no JSON"));
    if (!web::say_wanted()) web::say_text(view::text_of(done ? *done : view::Json{{"error", done.error().message}}));
}
}

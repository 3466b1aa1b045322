// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Of every format a file is read once, from looking into it to the grid, and opened a few times.
#include <sys/inotify.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/grid_file.hpp>
#include <isotet/make.hpp>
#include <isotet/pack.hpp>
#include <isotet/packed_file.hpp>
#include <isotet/write.hpp>

#include "readers/foam_sample.hpp"
#include "readers/grdecl_sample.hpp"
#include "support/places.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

namespace fs = std::filesystem;

/// Bytes that a process took from files so far, by read() of all kinds.
std::uint64_t bytes_read_by(const std::string& process) {
    std::ifstream file("/proc/" + process + "/io");
    std::string word;
    std::uint64_t bytes = 0;
    file >> word >> bytes;
    return word == "rchar:" ? bytes : 0;
}

/// This process and its children that live.
std::map<std::string, std::uint64_t> bytes_read() {
    std::map<std::string, std::uint64_t> all{{"self", bytes_read_by("self")}};
    for (const auto& entry : fs::directory_iterator("/proc")) {
        const std::string process = entry.path().filename();
        std::ifstream file(entry.path() / "stat");
        std::string stat;
        if (process.find_first_not_of("0123456789") != std::string::npos || !std::getline(file, stat)) continue;
        const std::size_t behind_name = stat.rfind(')');
        if (behind_name == std::string::npos || std::stol(stat.substr(behind_name + 4)) != ::getpid()) continue;
        all[process] = bytes_read_by(process);
    }
    return all;
}

std::uint64_t counted_sum(const std::map<std::string, std::uint64_t>& bytes) {
    std::uint64_t sum = 0;
    for (const auto& [process, of_it] : bytes) sum += of_it;
    return sum;
}

/// How often files are opened, by whomever. Two opens with nothing between them may count as one.
class CountedOpens {
public:
    explicit CountedOpens(const std::vector<std::string>& files) : queue_(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
        for (const std::string& file : files)
            EXPECT_GE(::inotify_add_watch(queue_, file.c_str(), IN_OPEN | IN_CLOSE | IN_ACCESS), 0) << file;
    }
    CountedOpens(const CountedOpens&) = delete;
    CountedOpens& operator=(const CountedOpens&) = delete;
    ~CountedOpens() { ::close(queue_); }

    std::size_t count() {
        alignas(inotify_event) std::array<char, 1 << 16> events{};
        std::size_t opens = 0;
        for (ssize_t bytes = 0; (bytes = ::read(queue_, events.data(), events.size())) > 0;)
            for (ssize_t at = 0; at < bytes;) {
                const auto* const event = reinterpret_cast<const inotify_event*>(events.data() + at);
                EXPECT_EQ(event->mask & IN_Q_OVERFLOW, 0U);
                opens += (event->mask & IN_OPEN) != 0 ? 1 : 0;
                at += static_cast<ssize_t>(sizeof(inotify_event) + event->len);
            }
        return opens;
    }

private:
    int queue_;
};

/// What is read of /proc and of control groups, to find out how much memory is free, and of libraries.
constexpr std::uint64_t bytes_of_this = 64 << 10, bytes_of_process = 128 << 10;
/// To find out the format, and what a reader looks at before it knows where the rest lies.
constexpr std::uint64_t bytes_of_heads = 64 << 10;

struct CountedSample {
    std::string path;
    std::vector<std::string> others = {}; ///< that it is read with
    std::size_t opens = 10;               ///< of each file at most
    std::uint64_t more = 0;               ///< bytes that may be read twice

    std::vector<std::string> files() const {
        std::vector<std::string> all = others;
        all.push_back(path);
        return all;
    }
};

using CountedUse = std::function<Result<void>(const std::string& path)>;

void expect_read_once(const CountedSample& sample, const std::string& what, const CountedUse& use) {
    std::uint64_t size = 0;
    for (const std::string& file : sample.files()) size += fs::is_regular_file(file) ? fs::file_size(file) : 0;
    const auto before = bytes_read();
    CountedOpens opens(sample.files());
    const auto done = use(sample.path);
    ASSERT_TRUE(done) << sample.path << ": " << done.error().message;
    const std::size_t opened = opens.count();
    const auto after = bytes_read();
    std::uint64_t most = size + size / 20 + bytes_of_heads * sample.files().size() + bytes_of_this + sample.more;
    for (const auto& [process, bytes] : after)
        if (!before.contains(process)) most += bytes_of_process;
    // What ended children have read counts as this process's.
    const std::uint64_t read = counted_sum(after) - counted_sum(before);
    EXPECT_LE(read, most) << what << " " << sample.path << " of " << size << " bytes";
    EXPECT_LE(opened, sample.opens * sample.files().size()) << what << " " << sample.path;
    if (std::getenv("ISOTET_SHOW_BYTES"))
        fmt::print("{:8} {:60} size {:9} read {:9} opens {}\n", what, sample.path, size, read, opened);
}

Result<void> read_counted(const std::string& path) {
    const auto file = GridFile::open(path);
    if (!file) return file.error();
    const auto grid = file->read();
    return grid ? Result<void>() : grid.error();
}

/// A surface of the first field, of which the cells around it are read alone where that can be done.
Result<void> contour_counted(const std::string& path) {
    const auto file = GridFile::open(path);
    if (!file) return file.error();
    for (const FieldInfo& field : file->info().fields) {
        if (field.components != 1) continue;
        const auto made = file->contour(field.name, std::array{0.25});
        return made ? Result<void>() : made.error();
    }
    return {};
}

std::string counted_data(const std::string& name) { return (source_folder() / "data" / name).string(); }

std::vector<std::string> files_with(const std::string& folder, std::string_view ending) {
    std::vector<std::string> files;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ending) files.push_back(entry.path().string());
    return files;
}

/// Numbers as the text of an array.
template <class Number>
std::string counted_array(std::string_view name, int components, std::size_t count, const Number& number) {
    std::string text =
        fmt::format(R"(<DataArray type="Float64" Name="{}" NumberOfComponents="{}" format="ascii">)", name, components);
    for (std::size_t i = 0; i < count * static_cast<std::size_t>(components); ++i)
        fmt::format_to(std::back_inserter(text), "{} ", number(i));
    return text + "</DataArray>";
}

/// VTK's structured kinds, and an index of each.
class CountedStructured {
public:
    explicit CountedStructured(const TemporaryFolder& folder) : folder_(folder) {}

    std::map<std::string, CountedSample> write() const {
        const auto third = [](std::size_t) { return 1.0 / 3; };
        const std::string ticks = counted_array("t", 1, side, [](std::size_t i) { return static_cast<double>(i); });
        std::map<std::string, CountedSample> all;
        add(all, "vti", "ImageData", R"( Origin="0 0 0" Spacing="1 1 1")", "");
        add(all, "vtr", "RectilinearGrid", "", "<Coordinates>" + ticks + ticks + ticks + "</Coordinates>");
        const std::string points = counted_array("p", 3, side * side * side, third);
        add(all, "vts", "StructuredGrid", "", "<Points>" + points + "</Points>");
        return all;
    }

private:
    static constexpr std::size_t side = 40;

    void add(std::map<std::string, CountedSample>& all, const std::string& ending, const std::string& type,
             const std::string& attributes, const std::string& geometry) const {
        const std::string extent = fmt::format("0 {0} 0 {0} 0 {0}", side - 1);
        const std::string values =
            counted_array("f", 1, side * side * side, [](std::size_t i) { return static_cast<double>(i % 97) / 97; });
        const std::string piece = folder_.write(
            "a." + ending, fmt::format(R"(<VTKFile type="{0}"><{0} WholeExtent="{1}"{2}><Piece Extent="{1}">)"
                                       "<PointData>{3}</PointData>{4}</Piece></{0}></VTKFile>",
                                       type, extent, attributes, values, geometry));
        all[ending] = {piece};
        const std::string index =
            folder_.write("b.p" + ending, fmt::format(R"(<VTKFile type="P{0}"><P{0} WholeExtent="{1}"{2}>)"
                                                      R"(<Piece Extent="{1}" Source="a.{3}"/></P{0}></VTKFile>)",
                                                      type, extent, attributes, ending));
        all["p" + ending] = {index, {piece}};
    }

    const TemporaryFolder& folder_;
};

std::string counted_vtu(const Grid& grid) {
    const std::size_t points = grid.points.tuples(), cells = grid.cells.count();
    std::string text = fmt::format(R"(<VTKFile type="UnstructuredGrid"><UnstructuredGrid>)"
                                   R"(<Piece NumberOfPoints="{}" NumberOfCells="{}">)",
                                   points, cells);
    text +=
        "<PointData>" + counted_array("f", 1, points, [&](std::size_t i) { return grid.point_fields[0].values.at(i); });
    text += "</PointData><Points>" +
            counted_array("p", 3, points, [&](std::size_t i) { return grid.points.at(i / 3, i % 3); });
    text += R"(</Points><Cells><DataArray type="Int32" Name="connectivity" format="ascii">)";
    for (std::size_t i = 0; i < grid.cells.connectivity.size(); ++i)
        fmt::format_to(std::back_inserter(text), "{} ", static_cast<int>(grid.cells.connectivity.at(i)));
    text += R"(</DataArray><DataArray type="Int32" Name="offsets" format="ascii">)";
    for (std::size_t i = 1; i <= cells; ++i) fmt::format_to(std::back_inserter(text), "{} ", 4 * i);
    text += R"(</DataArray><DataArray type="UInt8" Name="types" format="ascii">)";
    for (std::size_t i = 0; i < cells; ++i) text += "10 ";
    return text + "</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>";
}

std::string counted_frd(const Grid& grid) {
    std::string text = fmt::format("    1C\n    2C{:30}{:37}\n", grid.points.tuples(), 1);
    const auto add = [&]<class... Values>(fmt::format_string<Values...> form, Values&&... values) {
        fmt::format_to(std::back_inserter(text), form, std::forward<Values>(values)...);
    };
    for (std::size_t i = 0; i < grid.points.tuples(); ++i)
        add(" -1{:10}{:12.5E}{:12.5E}{:12.5E}\n", i + 1, grid.points.at(i, 0), grid.points.at(i, 1),
            grid.points.at(i, 2));
    add(" -3\n    3C{:30}{:37}\n", grid.cells.count(), 1);
    for (std::size_t i = 0; i < grid.cells.count(); ++i) {
        add(" -1{:10}{:5}{:5}{:5}\n -2", i + 1, 3, 0, 1);
        for (std::size_t k = 0; k < 4; ++k) add("{:10}", static_cast<int>(grid.cells.connectivity.at(4 * i + k)) + 1);
        text += '\n';
    }
    return text + " -3\n 9999\n";
}

std::string counted_geometry(const Grid& grid) {
    std::string text =
        fmt::format("a\nb\nnode id off\nelement id off\npart\n{:10}\np\ncoordinates\n{:10}\n", 1, grid.points.tuples());
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t i = 0; i < grid.points.tuples(); ++i)
            fmt::format_to(std::back_inserter(text), "{:12.5E}\n", grid.points.at(i, axis));
    fmt::format_to(std::back_inserter(text), "tetra4\n{:10}\n", grid.cells.count());
    for (std::size_t i = 0; i < grid.cells.connectivity.size(); ++i)
        fmt::format_to(std::back_inserter(text), "{:10}{}", static_cast<int>(grid.cells.connectivity.at(i)) + 1,
                       i % 4 == 3 ? "\n" : "");
    return text;
}

/// Files of the formats that data/ has none of.
std::map<std::string, std::vector<CountedSample>> counted_files(const TemporaryFolder& folder) {
    std::map<std::string, std::vector<CountedSample>> all;
    for (auto& [format, sample] : CountedStructured(folder).write()) all[format].push_back(sample);
    const Grid grid = make_grid({.shape = "kuhn", .side = 16, .fields = {"sphere"}}).value();
    const std::string vtu = folder.file("a.vtu"), vtk = folder.file("a.vtk"), packed = folder.file("a.isotet");
    EXPECT_TRUE(write_grid(grid, vtu));
    EXPECT_TRUE(write_grid(grid, vtk));
    EXPECT_TRUE(write_grid(grid, folder.file("z.vtu"), {.compression = Compression::zlib}));
    all["vtu"] = {{vtu}, {folder.file("z.vtu")}, {folder.write("text.vtu", counted_vtu(grid))}};
    all["vtk"] = {{vtk}};
    for (const auto& [ending, type] :
         std::map<std::string, std::string>{{"vtm", "vtkMultiBlockDataSet"}, {"vtpd", "vtkPartitionedDataSet"}})
        all[ending] = {{folder.write("a." + ending, fmt::format(R"(<VTKFile type="{0}"><{0}>)"
                                                                R"(<DataSet index="0" file="a.vtu"/></{0}></VTKFile>)",
                                                                type)),
                        {vtu}}};
    all["vtpc"] = {{folder.write("a.vtpc", R"(<VTKFile type="vtkPartitionedDataSetCollection">)"
                                           R"(<vtkPartitionedDataSetCollection><Partitions index="0">)"
                                           R"(<DataSet index="0" file="a.vtu"/></Partitions>)"
                                           "</vtkPartitionedDataSetCollection></VTKFile>"),
                    {vtu}}};
    all["pvd"] = {{folder.write("a.pvd", R"(<VTKFile type="Collection"><Collection>)"
                                         R"(<DataSet timestep="1" file="text.vtu"/></Collection></VTKFile>)"),
                   {folder.file("text.vtu")}}};
    all["series"] = {
        {folder.write("a.vtu.series", R"({"file-series-version":"1.0","files":[{"name":"a.vtu","time":1}]})"), {vtu}}};
    const auto field = find_field(grid, "sphere").value();
    EXPECT_TRUE(save_packed(pack(grid, field).value(), packed));
    all["isotet"] = {{packed}};
    all["frd"] = {{folder.write("a.frd", counted_frd(grid))}};
    all["grdecl"] = {{folder.write("a.grdecl", grdecl_box({60, 50, 20, 30, even_layers(0)}, ""))}};
    const std::string geometry = folder.write("a.geo", counted_geometry(grid));
    all["ensight"] = {{folder.write("a.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: a.geo\n"), {geometry}}};
    std::vector<std::string> foam;
    for (const auto& [name, text] : foam_case(foam_box(20, [](int, int, int) { return false; }),
                                              [](const std::array<double, 3>& at) { return at[0]; }, {}))
        foam.push_back(folder.write("foam/" + name, text));
    all["openfoam"] = {{folder.write("foam/a.foam", "x"), foam}};
    return all;
}

TEST(EveryFormat, IsReadOnce) {
    const TemporaryFolder folder;
    auto samples = counted_files(folder);
    const auto add = [&](const std::string& format, const std::string& name,
                         std::vector<std::string> others = {}) -> CountedSample& {
        return samples[format].emplace_back(CountedSample{counted_data(name), std::move(others)});
    };
    add("vtu", "vtu/artery_flow_tet_wedge.vtu");
    add("vtu", "vtu/two_phase_box_tets_dup_points.vtu");
    add("vtk", "vtk/lox_post_pressure.vtk");
    add("pvtu", "pvtu/monodomain/monodomain3d.pvtu", files_with(counted_data("pvtu/monodomain"), ".vtu"));
    add("vth", "amr/sphere_amr.vth", files_with(counted_data("amr/sphere_amr"), ".vti"));
    // HDF5 reads names and places of arrays for looking and for reading.
    constexpr std::uint64_t names = 256 << 10;
    add("vtkhdf", "vtkhdf/can_hex.hdf").more = names;
    add("vtkhdf", "amr/sphere_amr.vtkhdf").more = names;
    for (const char* name : {"inclusions_v22_ascii", "inclusions_v41_ascii", "inclusions_v41_binary"})
        add("gmsh", fmt::format("msh/{}.msh", name));
    add("medit", "medit/cube_sphere_26k.meshb");
    add("tetgen", "tetgen/ellipsoid_16k.ele", {counted_data("tetgen/ellipsoid_16k.node")});
    add("gocad", "gocad/geomodel3d_tsolid.so");
    add("ucd", "avs_ucd/tet_attributes.inp");
    add("exodus", "exodus/mixed_blocks_hdf5.exo").more = names;
    add("exodus", "exodus/tension_tets_stress_3steps.e");
    for (const char* name : {"cgns/wall_distance_adf.cgns", "cgns/wall_distance_hdf5.cgns"}) {
        CountedSample& sample = add("cgns", name);
        sample.opens = 16; // CGNS's library finds out the kind of the file
        sample.more = names;
    }
    add("xdmf", "xdmf/tet4_vertex.xmf", {counted_data("xdmf/tet4_vertex.h5")});
    add("xdmf", "xdmf/no_checkpoint.xdmf", {counted_data("xdmf/no_checkpoint.h5")});
    const std::set<std::string> as_others{"vthb", "med"}; // as vth; as VTKHDF and Exodus in HDF5
    for (const Format& format : formats()) {
        if (!format.reads_grid || as_others.contains(format.name)) continue;
        EXPECT_FALSE(samples[format.name].empty()) << format.name;
        for (const CountedSample& sample : samples[format.name]) {
            expect_read_once(sample, "read", read_counted);
            expect_read_once(sample, "contour", contour_counted);
        }
    }
}

} // namespace
} // namespace isotet::test

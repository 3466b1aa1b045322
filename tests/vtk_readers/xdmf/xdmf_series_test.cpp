// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// XDMF as FEniCSx, OpenGeoSys, meshio and DOLFIN write series: XInclude, several grids in a domain, times.
#include <gtest/gtest.h>

#include <isotet/read.hpp>

#include "support/temporary_folder.hpp"
#include "vtk_readers/hdf5_writer.hpp"
#include "vtk_readers/xdmf/xdmf_text.hpp"

namespace isotet::test {
namespace {

class ReadXdmfSeries : public testing::Test {
protected:
    Result<ReadResult> read_domain(const std::string& domain, const ReadOptions& options = {}) {
        return read(folder_.write("grid.xdmf", xdmf_document(domain)), options);
    }
    Result<ReadResult> read_step(const std::string& domain, std::size_t step) {
        ReadOptions options;
        options.step = step;
        return read_domain(domain, options);
    }
    std::string error_of(const std::string& domain) {
        const auto result = read_domain(domain);
        return result ? "read" : result.error().message;
    }
    TemporaryFolder folder_;
};

/// A series as dolfinx writes it, with another way to include the mesh.
std::string series_with(const std::string& include) {
    std::string steps;
    for (const char* time : {"0", "0.5"})
        steps += xdmf_grid("u", include + xdmf_time(time) + xdmf_field("u", std::string(time) + " 2 3 4 5"));
    return xdmf_mesh() + xdmf_collection("u", "Temporal", steps);
}

std::string included(const std::string& xpointer) { return "<xi:include xpointer='" + xpointer + "'/>"; }

TEST_F(ReadXdmfSeries, MayHaveBlanksAroundTimes) {
    const std::string steps = xdmf_grid("u", xdmf_points() + xdmf_tets() + xdmf_time(" 0.25 ")) +
                              xdmf_grid("u", xdmf_points() + xdmf_tets() + xdmf_time("5.0e-1\n"));
    const auto result = read_step(xdmf_collection("u", "Temporal", steps), 1);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->info.times, (std::vector<double>{0.25, 0.5}));
}

TEST_F(ReadXdmfSeries, FollowsEveryFormOfXpointer) {
    const std::string both = "/*[self::Topology or self::Geometry]";
    const std::vector<std::string> includes = {
        included("xpointer(/Xdmf/Domain/Grid[@GridType=\"Uniform\"][1]" + both + ")"),
        included("xpointer(//Grid[@Name=\"mesh\"]" + both + ")"),
        included("xpointer( /Xdmf/Domain/Grid[1]" + both + " )"),
        included("xpointer(/Xdmf/Domain/Grid[@Name=\"mesh\"]/*)"),
        included("xpointer(/Xdmf/Domain/Grid/Geometry|/Xdmf/Domain/Grid/Topology)"),
        included("xpointer(/Xdmf/Domain/Grid/Geometry)") + included("xpointer(/Xdmf/Domain/Grid/Topology)"),
        included("element(/1/1/1/1)") + included("element(/1/1/1/2)"),
        included("xmlns(x=urn:x)xpointer(/Nothing)xpointer(//Grid[@Name=\"mesh\"]" + both + ")"),
        "<xi:include href='grid.xdmf' xpointer='element(/1/1/1/1)'/>" + included("element(/1/1/1/2)"),
        "<n0:include xmlns:n0='https://www.w3.org/2003/XInclude' xpointer='xpointer(//Grid[@Name=\"mesh\"]" + both +
            ")'/>",
        "<include xmlns='http://www.w3.org/2001/XInclude' href='' xpointer='xpointer(/Xdmf/Domain/Grid[1]/*)'/>",
        std::string("<xi:include xpointer=\"xpointer(//Grid[@Name='mesh']/*)\"/>"),
        std::string("<xi:include xpointer=\"xpointer(//Grid[@Name=&quot;mesh&quot;]/*)\"/>"),
        std::string("<Geometry Reference='/Xdmf/Domain/Grid/Geometry'/><Topology "
                    "Reference='XML'>/Xdmf/Domain/Grid/Topology</Topology>")};
    for (const std::string& include : includes) {
        const auto result = read_step(series_with(include), 1);
        ASSERT_TRUE(result) << include << ": " << result.error().message;
        EXPECT_EQ(result->info.times, (std::vector<double>{0, 0.5}));
        EXPECT_EQ(result->grid.points.tuples(), 5u);
        EXPECT_EQ(result->grid.cells.count(), 2u);
        ASSERT_EQ(result->grid.point_fields.size(), 1u);
        EXPECT_EQ(result->grid.point_fields[0].values.at(0), 0.5);
        EXPECT_TRUE(result->info.blocks.empty());
        EXPECT_TRUE(result->notes.empty()) << result->notes.front();
    }
}

TEST_F(ReadXdmfSeries, FollowsIds) {
    std::string domain = series_with(included("points") + included("xpointer(id(\"cells\"))"));
    domain.replace(domain.find("<Geometry "), 10, "<Geometry id='points' ");
    domain.replace(domain.find("<Topology "), 10, "<Topology xml:id='cells' ");
    const auto result = read_step(domain, 1);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.cells.count(), 2u);
}

/// As DOLFIN does: later steps include the mesh of the first.
TEST_F(ReadXdmfSeries, FollowsIncludesOfTheFirstStep) {
    const std::string first =
        xdmf_grid("mesh", xdmf_points() + xdmf_tets() + xdmf_time("0") + xdmf_field("f", "0 2 3 4 5"));
    const std::string second =
        xdmf_grid("f", included("xpointer(//Grid[@Name=\"TimeSeries\"]/Grid[1]/*[self::Topology or self::Geometry])") +
                           xdmf_time("2") + xdmf_field("f", "1 2 3 4 5"));
    const std::string third =
        xdmf_grid("f", included("xpointer(//Grid[@Name=\"TimeSeries\"]/Grid[2]/*[1])") + xdmf_time("3"));
    const std::string series = xdmf_collection("TimeSeries", "Temporal", first + second);
    EXPECT_EQ(read_step(series, 1).value().grid.point_fields.at(0).values.at(0), 1);
    const auto further = read_step(xdmf_collection("TimeSeries", "Temporal", first + second + third), 2);
    ASSERT_TRUE(further) << further.error().message;
    EXPECT_EQ(further->grid.cells.count(), 2u) << "an include of an include";
}

TEST_F(ReadXdmfSeries, IncludesFilesBelowItsFolder) {
    folder_.write("mesh.xdmf", xdmf_document(xdmf_mesh()));
    folder_.write("points.xml", xdmf_points());
    EXPECT_EQ(read_domain("<xi:include href='mesh.xdmf'/>").value().grid.cells.count(), 2u);
    EXPECT_EQ(
        read_domain("<xi:include href='mesh.xdmf' xpointer='xpointer(/Xdmf/Domain/Grid)'/>").value().grid.cells.count(),
        2u);
    const auto result = read_domain(xdmf_grid("g", "<xi:include href='points.xml'/>" + xdmf_tets()));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->info.files.size(), 2u);
    EXPECT_NE(error_of("<xi:include href='../mesh.xdmf'/>").find("only files below"), std::string::npos);
    EXPECT_NE(error_of("<xi:include href='/etc/hostname'/>").find("only files below"), std::string::npos);
    EXPECT_NE(error_of("<xi:include href='http://localhost/mesh.xdmf'/>").find("a URL"), std::string::npos);
    EXPECT_NE(error_of("<xi:include href='absent.xdmf'/>").find("is not there"), std::string::npos);
    folder_.write("circle.xdmf", xdmf_document("<xi:include href='grid.xdmf'/>"));
    EXPECT_NE(error_of("<xi:include href='circle.xdmf'/>").find("without end"), std::string::npos);
}

TEST_F(ReadXdmfSeries, FindsDataBesideTheFileThatIsIncludedOrTheFirstOne) {
    std::filesystem::create_directories(folder_.file("mesh"));
    const auto write = [&](const std::string& name, double above) {
        Hdf5Writer file(folder_.file(name));
        file.data<double>("/points", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, above, 0, 0, -1}, {5, 3});
    };
    const std::string points =
        "<Geometry>" + xdmf_item("Format='HDF' Dimensions='5 3'", "points.h5:/points") + "</Geometry>";
    folder_.write("mesh/mesh.xdmf", xdmf_document(xdmf_grid("mesh", points + xdmf_tets())));
    const std::string domain = "<xi:include href='mesh/mesh.xdmf'/>";
    EXPECT_NE(error_of(domain).find("mesh.xdmf names \"points.h5\", which is not there"), std::string::npos);
    write("points.h5", 7);
    EXPECT_EQ(read_domain(domain).value().grid.points.at(3, 2), 7);
    write("mesh/points.h5", 9);
    EXPECT_EQ(read_domain(domain).value().grid.points.at(3, 2), 9);
}

TEST_F(ReadXdmfSeries, IncludesThatLeadNowhereAreErrors) {
    const auto message = [&](const std::string& include) { return error_of(xdmf_mesh() + xdmf_grid("g", include)); };
    for (const char* nothing :
         {"xpointer(/Xdmf/Nothing)", "xpointer(][)", "xpointer(//*//*)", "element(/1/9)", "element(/1/1/x)", "absent",
          "xpointer(/Xdmf/Domain/Grid", "xpointer(id(absent))", "", "here()"})
        EXPECT_NE(message(included(nothing)).find("xi:include"), std::string::npos) << nothing;
    EXPECT_NE(message(included("xpointer(/Xdmf/Domain)")).find("includes the element that it is in"),
              std::string::npos);
    EXPECT_NE(message(included("xpointer(//Grid[2]/*[1])")).find("without end"), std::string::npos);
    EXPECT_NE(message("<xi:include parse='text' href='grid.xdmf'/>").find("includes text"), std::string::npos);
}

/// As dolfinx writes functions: each in a collection of its own, on one mesh.
TEST_F(ReadXdmfSeries, PutsFieldsOfOneMeshTogether) {
    const std::string mesh = included("xpointer(/Xdmf/Domain/Grid[1]/*[self::Topology or self::Geometry])");
    const std::string domain =
        xdmf_grid("mesh", xdmf_points() + xdmf_tets() + xdmf_field("material", "7 8", "Cell")) +
        xdmf_collection("u", "Temporal",
                        xdmf_grid("u", mesh + xdmf_time("0") + xdmf_field("u", "0 2 3 4 5")) +
                            xdmf_grid("u", mesh + xdmf_time("0.5") + xdmf_field("u", "1 2 3 4 5"))) +
        xdmf_collection("q", "Temporal",
                        xdmf_grid("q", mesh + xdmf_time("0.5") + xdmf_field("q", "1 2", "Cell")) +
                            xdmf_grid("q", mesh + xdmf_time("2") + xdmf_field("q", "3 4", "Cell")));
    const auto first = read_step(domain, 0), second = read_step(domain, 1), third = read_step(domain, 2);
    ASSERT_TRUE(first && second && third);
    EXPECT_EQ(first->info.times, (std::vector<double>{0, 0.5, 2}));
    EXPECT_EQ(first->info.fields.size(), 3u);
    EXPECT_EQ(first->grid.cell_fields.size(), 1u);
    ASSERT_EQ(first->notes.size(), 1u);
    EXPECT_EQ(first->notes[0], "step 0 has no values of \"q\" (step 1 has)");
    EXPECT_EQ(second->grid.point_fields.at(0).values.at(0), 1);
    EXPECT_EQ(second->grid.cell_fields.size(), 2u);
    EXPECT_EQ(third->grid.cell_fields.at(1).values.at(1), 4);
    EXPECT_TRUE(third->grid.point_fields.empty());
    EXPECT_EQ(third->grid.cells.count(), 2u);
    ReadOptions options;
    options.point_fields = {"u"};
    options.step = 2;
    EXPECT_EQ(read_domain(domain, options).error().message, "point field 'u' has no values at step 2");
}

/// Several domains, and meshes that are one although nothing refers to the other.
TEST_F(ReadXdmfSeries, ReadsAllDomains) {
    const auto result =
        read_domain(xdmf_grid("a", xdmf_points() + xdmf_tets() + xdmf_field("p", "1 2 3 4 5")) + "</Domain><Domain>" +
                    xdmf_grid("b", xdmf_tets() + xdmf_points() + xdmf_field("q", "6 7 8 9 10")));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.cells.count(), 2u);
    EXPECT_EQ(result->grid.point_fields.size(), 2u);
    EXPECT_EQ(result->notes,
              std::vector<std::string>{"the grids of all 2 domains are read: other programs read those of the first"});
}

TEST_F(ReadXdmfSeries, OtherMeshesAreBlocks) {
    const std::string other =
        "<Geometry>" + xdmf_item("Dimensions='4 3'", "0 0 0 1 0 0 0 1 0 0 0 9") + "</Geometry>" + xdmf_tets("0 1 2 3");
    const std::string domain = xdmf_mesh() + xdmf_grid("other", other + xdmf_field("p", "1 2 3 4"));
    const auto all = read_domain(domain);
    ASSERT_TRUE(all) << all.error().message;
    EXPECT_EQ(all->grid.cells.count(), 3u);
    ASSERT_EQ(all->info.blocks.size(), 2u);
    EXPECT_EQ(all->info.blocks[1].name, "other");
    EXPECT_EQ(all->info.blocks[1].cells, 1u);
    ReadOptions options;
    options.blocks = {"other"};
    EXPECT_EQ(read_domain(domain, options).value().grid.points.tuples(), 4u);
}

/// As mesh tags of dolfinx: cells in another order, some of them, and surfaces.
TEST_F(ReadXdmfSeries, TagsOfCellsAreFieldsOfTheMesh) {
    const std::string points = included("xpointer(/Xdmf/Domain/Grid/Geometry)");
    const std::string some = xdmf_grid("some", points + xdmf_tets("4 0 1 2") + xdmf_field("some", "8", "Cell"));
    const auto tags =
        read_domain(xdmf_mesh() +
                    xdmf_grid("all", points + xdmf_tets("4 0 1 2 3 2 1 0") + xdmf_field("all", "8 9", "Cell")) + some +
                    xdmf_grid("facets", points + "<Topology TopologyType='Triangle'>" +
                                            xdmf_item("NumberType='Int'", "0 1 2 0 2 3") + "</Topology>" +
                                            xdmf_field("facets", "1 2", "Cell")));
    ASSERT_TRUE(tags) << tags.error().message;
    EXPECT_EQ(tags->grid.points.tuples(), 5u);
    EXPECT_EQ(tags->grid.cells.count(), 2u);
    ASSERT_EQ(tags->grid.cell_fields.size(), 2u);
    EXPECT_EQ(tags->grid.cell_fields[0].values.at(0), 9);
    EXPECT_EQ(tags->grid.cell_fields[0].values.at(1), 8);
    EXPECT_NE(tags->grid.cell_fields[1].values.at(0), tags->grid.cell_fields[1].values.at(0)) << "NaN";
    EXPECT_EQ(tags->grid.cell_fields[1].values.at(1), 8);
    EXPECT_EQ(tags->notes,
              (std::vector<std::string>{"the cells of grid \"all\" are cells of \"mesh\": they are one grid",
                                        "the cells of grid \"some\" are cells of \"mesh\": they are one "
                                        "grid",
                                        "grid 'facets' is left out: its cells have no volume"}));
}

/// As DOLFIN writes several functions into one file.
TEST_F(ReadXdmfSeries, AMeshThatIsStatedAgainForEachFunctionIsOneGrid) {
    const auto two = read_domain(xdmf_grid("a", xdmf_points("1") + xdmf_tets() + xdmf_field("p", "1 2 3 4 5")) +
                                 xdmf_grid("b", xdmf_points("1.0") + xdmf_tets() + xdmf_field("q", "6 7 8 9 10")));
    ASSERT_TRUE(two) << two.error().message;
    EXPECT_EQ(two->grid.cells.count(), 2u);
    EXPECT_EQ(two->grid.points.tuples(), 5u);
    ASSERT_EQ(two->grid.point_fields.size(), 2u);
    EXPECT_EQ(two->grid.point_fields[0].values.at(4), 5);
    EXPECT_EQ(two->grid.point_fields[1].values.at(4), 10);
    EXPECT_EQ(two->notes, (std::vector<std::string>{"the cells of grid \"b\" are cells of \"a\": they are one grid"}));
}

TEST_F(ReadXdmfSeries, CollectionsOfBothKindsNestEitherWay) {
    const auto block = [](const std::string& name, const std::string& x, const std::string& time) {
        return xdmf_grid(name, xdmf_points(x) + xdmf_tets() + time + xdmf_field("p", x + " 2 3 4 5"));
    };
    const std::string outside = xdmf_collection(
        "all", "Temporal",
        xdmf_collection("s0", "Spatial", xdmf_time("0.5") + block("a", "1", "") + block("b", "2", "")) +
            xdmf_collection("s1", "Spatial", xdmf_time("1.5") + block("a", "3", "") + block("b", "4", "")));
    const std::string inside =
        "<Grid Name='tree' GridType='Tree'>" +
        xdmf_collection("a", "Temporal", block("", "1", xdmf_time("0.5")) + block("", "3", xdmf_time("1.5"))) +
        xdmf_collection("b", "Temporal", block("", "2", xdmf_time("0.5")) + block("", "4", xdmf_time("1.5"))) +
        "</Grid>";
    for (const std::string& domain : {outside, inside}) {
        const auto result = read_step(domain, 1);
        ASSERT_TRUE(result) << result.error().message;
        EXPECT_EQ(result->info.times, (std::vector<double>{0.5, 1.5}));
        EXPECT_EQ(result->grid.cells.count(), 3u) << "one cell is in both blocks, and counts once";
        ASSERT_EQ(result->info.blocks.size(), 2u);
        EXPECT_EQ(result->info.blocks[0].name, "a");
        EXPECT_EQ(result->info.blocks[1].name, "b");
        ReadOptions options;
        options.step = 1;
        options.blocks = {"b"};
        EXPECT_EQ(read_domain(domain, options).value().grid.points.at(3, 2), 4);
    }
}

TEST_F(ReadXdmfSeries, TheTimeOfACollectionGoesBeforeThoseInIt) {
    const auto block = [](const std::string& x, const std::string& time) {
        return xdmf_grid("block", xdmf_points(x) + xdmf_tets() + xdmf_time(time));
    };
    const auto times = [&](const std::string& of_all) {
        return read_domain(xdmf_collection("all", "Spatial", of_all + block("1", "0.1") + block("2", "0.1000001")))
            .value()
            .info.times;
    };
    EXPECT_EQ(times(xdmf_time("7")), std::vector<double>{7});
    EXPECT_EQ(times(""), (std::vector<double>{0.1, 0.1000001}));
}

TEST_F(ReadXdmfSeries, TimesAreListedInAnyWay) {
    {
        Hdf5Writer file(folder_.file("times.h5"));
        file.data<double>("/t", {2, 4, 8}, {3});
    }
    const std::string step = xdmf_grid("g", xdmf_points() + xdmf_tets());
    const auto times = [&](const std::string& time) {
        return read_domain(xdmf_collection("all", "Temporal", time + step + step + step)).value().info.times;
    };
    using Times = std::vector<double>;
    EXPECT_EQ(times(""), (Times{0, 1, 2}));
    EXPECT_EQ(times("<Time TimeType='List'>" + xdmf_item("Dimensions='3'", "2 4 8") + "</Time>"), (Times{2, 4, 8}));
    EXPECT_EQ(times("<Time TimeType='List'>" + xdmf_item("Dimensions='3'", "0.1 0.2 1e-3") + "</Time>"),
              (Times{0.1, 0.2, 1e-3}));
    EXPECT_EQ(times("<Time TimeType='List'>" + xdmf_item("Format='HDF' Dimensions='3'", "times.h5:/t") + "</Time>"),
              (Times{2, 4, 8}));
    EXPECT_EQ(times("<Time Type='List'>2 4 8</Time>"), (Times{2, 4, 8}));
    EXPECT_EQ(times("<Time TimeType='HyperSlab'>" + xdmf_item("Dimensions='3'", "1 0.5 3") + "</Time>"),
              (Times{1, 1.5, 2}));
    EXPECT_EQ(times("<Time TimeType='Range'>" + xdmf_item("Dimensions='2'", "1 5") + "</Time>"), (Times{1, 3, 5}));
}

/// A run that was begun again, and grids with times but without a collection.
TEST_F(ReadXdmfSeries, GridsWithTimesMakeStepsWithoutACollection) {
    const auto at = [](const std::string& time, const std::string& value) {
        return xdmf_grid("g", xdmf_points() + xdmf_tets() + xdmf_time(time) + xdmf_field("p", value + " 2 3 4 5"));
    };
    const auto result = read_step(at("2", "7") + at("1", "6"), 1);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->info.times, (std::vector<double>{1, 2}));
    EXPECT_EQ(result->grid.point_fields.at(0).values.at(0), 7);
}

/// Some versions of dolfinx put the time behind the name.
TEST_F(ReadXdmfSeries, ATimeInANameIsNotPartOfIt) {
    const auto at = [](const std::string& time, const std::string& name) {
        return xdmf_grid("T", xdmf_points() + xdmf_tets() + xdmf_time(time) + xdmf_field(name, time + " 2 3 4 5"));
    };
    const std::string series = xdmf_collection(
        "T", "Temporal", at("0", "T/0") + at("0.5", "T/0_5") + at("1.25", "T/1.250000") + at("3", "T/4"));
    const auto result = read_step(series, 1);
    ASSERT_TRUE(result) << result.error().message;
    ASSERT_EQ(result->info.fields.size(), 2u);
    EXPECT_EQ(result->info.fields[0].name, "T");
    EXPECT_EQ(result->info.fields[1].name, "T/4") << "step 3 has the time 3";
    EXPECT_EQ(result->grid.point_fields.at(0).values.at(0), 0.5);
}

TEST_F(ReadXdmfSeries, OneBadAttributeDoesNotSpoilTheRest) {
    const std::string bad = xdmf_field("short", "1 2 3 4") + xdmf_field("words", "1 2 x 4 5") +
                            "<Attribute Name='gone'>" + xdmf_item("Format='HDF'", "absent.h5:/p") + "</Attribute>" +
                            "<Attribute Name='none'/><Attribute Reference='/Nothing'/>" +
                            xdmf_field("edges", "1", "Edge") + "<Attribute Name='odd'>" +
                            xdmf_item("NumberType='Quaternion' Dimensions='5'", "") + "</Attribute>" +
                            xdmf_field("p", "5 4 3 2 1") + xdmf_field("p", "1 2 3 4 5");
    const std::string domain = xdmf_grid("g", xdmf_points() + xdmf_tets() + bad);
    const auto result = read_domain(domain);
    ASSERT_TRUE(result) << result.error().message;
    ASSERT_EQ(result->grid.point_fields.size(), 1u);
    EXPECT_EQ(result->grid.point_fields[0].values.at(0), 5);
    EXPECT_EQ(result->info.left_out.size(), 8u) << testing::PrintToString(result->notes);
    EXPECT_EQ(inspect(folder_.file("grid.xdmf")).value().left_out.size(), 8u);
    for (const std::string& note : result->notes) EXPECT_NE(note.find(" left out: "), std::string::npos) << note;
    ReadOptions options;
    for (const char* name : {"short", "words", "gone", "none"}) {
        options.point_fields = {name};
        EXPECT_FALSE(read_domain(domain, options)) << name;
    }
    options.point_fields = {"p"};
    const auto sound = read_domain(domain, options);
    ASSERT_TRUE(sound) << sound.error().message;
}

TEST_F(ReadXdmfSeries, SetsAreFieldsOfOnesAndZeros) {
    const auto set = [](const std::string& name, const std::string& type, const std::string& numbers) {
        return "<Set Name=\"" + name + "\" SetType=\"" + type + "\">" +
               xdmf_item("Format=\"XML\" NumberType=\"Int\"", numbers) +
               "<Attribute Name=\"of the set\" Center=\"Node\">" + xdmf_item("Format=\"XML\"", "7 8") +
               "</Attribute></Set>";
    };
    const auto result = read_domain(xdmf_grid("g", xdmf_points() + xdmf_tets() + set("inlet", "Node", "4 0") +
                                                       set("core", "cell", "1") + set("skin", "Face", "0 1") +
                                                       set("far", "Node", "0 5") + xdmf_field("p", "5 4 3 2 1")));
    ASSERT_TRUE(result) << result.error().message;
    const auto &points = result->grid.point_fields, &cells = result->grid.cell_fields;
    ASSERT_EQ(points.size(), 2u);
    EXPECT_EQ(points[0].name, "p");
    EXPECT_EQ(points[1].name, "inlet");
    EXPECT_EQ(points[1].values.type(), ScalarType::uint8);
    for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(points[1].values.at(i), i % 4 == 0 ? 1 : 0);
    ASSERT_EQ(cells.size(), 1u);
    EXPECT_EQ(cells[0].name, "core");
    EXPECT_EQ(cells[0].values.at(0), 0);
    EXPECT_EQ(cells[0].values.at(1), 1);
    EXPECT_EQ(result->notes, (std::vector<std::string>{
                                 "attribute 'skin' is left out: its SetType is \"Face\", but Node and Cell are read",
                                 "point field 'far' is left out: it has the number 5, but 0 to 4 is the rule"}));
}

} // namespace
} // namespace isotet::test

// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Writes functions of degree 1 to 3 on a refined cube and a refined ball of hexahedra, in what deal.II's DataOut has.
#include <deal.II/base/data_out_base.h>
#include <deal.II/base/function_parser.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_out.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/vector.h>
#include <deal.II/numerics/data_out.h>
#include <deal.II/numerics/data_postprocessor.h>
#include <deal.II/numerics/vector_tools.h>
#include <fstream>
#include <map>
#include <string>

using namespace dealii;

namespace {

    struct Gradient : DataPostprocessorVector<3> {
        Gradient() : DataPostprocessorVector<3>("grad u", update_gradients) {}
        void evaluate_scalar_field(const DataPostprocessorInputs::Scalar<3>& in,
                                   std::vector<Vector<double>>& out) const override {
            for (unsigned int point = 0; point < out.size(); ++point)
                for (unsigned int axis = 0; axis < 3; ++axis)
                    out[point](axis) = in.solution_gradients[point][axis];
        }
    };

    void refine_towards_the_origin(Triangulation<3>& mesh) {
        for (const auto& cell : mesh.active_cell_iterators())
            if (cell->center().norm() < 0.6) cell->set_refine_flag();
        mesh.execute_coarsening_and_refinement();
    }

    template <class Write>
    void write(const std::string& file, const Write& writer) {
        std::ofstream out(file);
        writer(out);
    }

    void write_function(const std::string& name, const Triangulation<3>& mesh, unsigned int degree) {
        const FE_Q<3> element(degree);
        DoFHandler<3> unknowns(mesh);
        unknowns.distribute_dofs(element);
        FunctionParser<3> wave(1);
        wave.initialize("x,y,z", "sin(3*x)+cos(2*y)*z", std::map<std::string, double>());
        Vector<double> u(unknowns.n_dofs());
        const MappingQ<3> mapping(degree);
        VectorTools::interpolate(mapping, unknowns, wave, u);

        const Gradient gradient;
        for (const bool curved : {false, true}) {
            DataOut<3> out;
            DataOutBase::VtkFlags flags;
            flags.time = 0.5;
            flags.write_higher_order_cells = curved && degree > 1;
            out.set_flags(flags);
            out.attach_dof_handler(unknowns);
            out.add_data_vector(u, "u");
            out.add_data_vector(u, gradient);
            out.build_patches(mapping, degree, curved ? DataOut<3>::curved_inner_cells : DataOut<3>::no_curved_cells);
            const std::string stem = name + std::to_string(degree) + (curved ? "_curved" : "");
            write(stem + ".vtu", [&](std::ostream& file) { out.write_vtu(file); });
            write(stem + ".vtk", [&](std::ostream& file) { out.write_vtk(file); });
            if (!curved) write(stem + ".inp", [&](std::ostream& file) { out.write_ucd(file); });
        }
    }

} // namespace

int main() {
    for (const std::string name : {"cube", "ball"}) {
        Triangulation<3> mesh;
        if (name == "cube")
            GridGenerator::hyper_cube(mesh, -1, 1);
        else
            GridGenerator::hyper_ball(mesh);
        mesh.refine_global(1);
        const GridOut out;
        write(name + "_grid.vtk", [&](std::ostream& file) { out.write_vtk(mesh, file); });
        write(name + "_grid.vtu", [&](std::ostream& file) { out.write_vtu(mesh, file); });
        write(name + "_grid.msh", [&](std::ostream& file) { out.write_msh(mesh, file); });
        refine_towards_the_origin(mesh);
        for (const unsigned int degree : {1, 2, 3})
            write_function(name, mesh, degree);
    }
}

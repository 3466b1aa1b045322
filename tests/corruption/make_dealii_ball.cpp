// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Writes data/vtu/dealii_refined_ball.vtu with deal.II 9.4 (Debian's libdeal.ii-dev): a ball of curved hexahedra, some
// of them refined twice, as deal.II's DataOut writes it: each cell has points of its own. The field is 0 in the middle and
// 1 on the sphere, at hanging nodes constrained to what the larger cells have.
//
//   g++ -std=c++17 make_dealii_ball.cpp -o ball -ldeal.ii -ltbb -lmpi_cxx -lmpi -ltrilinos_teuchoscomm && ./ball A.vtu
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/vector.h>
#include <deal.II/numerics/data_out.h>
#include <deal.II/numerics/vector_tools.h>

#include <fstream>

using namespace dealii;

class Radius : public Function<3> {
public:
    double value(const Point<3>& p, const unsigned int = 0) const override { return p.norm(); }
};

int main(int, char** arguments) {
    Triangulation<3> mesh;
    GridGenerator::hyper_ball(mesh);
    mesh.refine_global(1);
    for (int step = 0; step < 2; ++step) {
        for (const auto& cell : mesh.active_cell_iterators())
            if (cell->center()[0] > 0.2 * step && cell->center()[1] > 0.1 + 0.2 * step) cell->set_refine_flag();
        mesh.execute_coarsening_and_refinement();
    }
    const FE_Q<3> element(1);
    DoFHandler<3> nodes(mesh);
    nodes.distribute_dofs(element);
    AffineConstraints<double> hanging;
    DoFTools::make_hanging_node_constraints(nodes, hanging);
    hanging.close();
    Vector<double> radius(nodes.n_dofs());
    VectorTools::interpolate(nodes, Radius(), radius);
    hanging.distribute(radius);
    DataOut<3> out;
    out.attach_dof_handler(nodes);
    out.add_data_vector(radius, "radius");
    out.build_patches();
    std::ofstream file(arguments[1]);
    out.write_vtu(file);
    return file.good() ? 0 : 1;
}

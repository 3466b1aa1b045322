# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""A page with a slider for the isovalue, by trame, which opens in a browser: pip install trame-pyvista."""

from pathlib import Path
from typing import Any

import pyvista as pv
from trame.app import get_server
from trame.ui.vuetify3 import SinglePageLayout
from trame.widgets import vuetify3
from trame_pyvista.ui import plotter_ui

from isotet.vtk import IsotetContour


def make_app(server: Any) -> IsotetContour:
    """Fills the page of a server; returns the filter that its slider moves."""
    grid = pv.read(Path(__file__).parents[2] / "data/vtu/artery_flow_tet_wedge.vtu")
    contour = IsotetContour(expected_surfaces=1000, compute_normals=False)
    contour.SetInputData(grid)
    contour.SetInputArrayToProcess(0, 0, 0, 0, "Umag")
    contour.SetValue(0, 0.2)
    plotter = pv.Plotter(off_screen=True)
    plotter.add_mesh(contour, scalars="p", cmap="viridis")

    def moved(isovalue: float, **_: Any) -> None:
        contour.SetValue(0, float(isovalue))
        contour.Update()
        server.controller.view_update()

    server.state.change("isovalue")(moved)
    with SinglePageLayout(server) as layout:
        layout.title.set_text("Speed in an artery")
        with layout.toolbar:
            vuetify3.VSlider(v_model=("isovalue", 0.2), min=0.02, max=0.5, step=0.005, hide_details=True)
        with layout.content:
            view = plotter_ui(plotter)
            server.controller.view_update = view.update
    return contour


if __name__ == "__main__":
    page: Any = get_server()
    make_app(page)
    page.start()

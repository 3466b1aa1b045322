# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# pip: ogs==6.5.9
# files: *.pvd *_VTK_ts_*.vtu *10.vtu *20.vtu *.xdmf
"""OpenGeoSys: heat in a box of hexahedra, of prisms and of tetrahedra in steps, as VTK files and as XDMF."""
import pathlib
import subprocess
import sys

BIN = pathlib.Path(sys.executable).parent
PROJECT = """<?xml version="1.0"?>
<OpenGeoSysProject>
 <meshes><mesh>{name}.vtu</mesh></meshes>
 <geometry>box.gml</geometry>
 <processes><process><name>heat</name><type>HEAT_CONDUCTION</type><integration_order>2</integration_order>
  <process_variables><process_variable>temperature</process_variable></process_variables>
  <secondary_variables><secondary_variable internal_name="heat_flux" output_name="heat_flux"/></secondary_variables>
 </process></processes>
 <media><medium><phases/><properties>
  <property><name>specific_heat_capacity</name><type>Constant</type><value>1</value></property>
  <property><name>density</name><type>Constant</type><value>1</value></property>
  <property><name>thermal_conductivity</name><type>Constant</type><value>0.5</value></property>
 </properties></medium></media>
 <time_loop><processes><process ref="heat"><nonlinear_solver>picard</nonlinear_solver>
  <convergence_criterion><type>DeltaX</type><norm_type>NORM2</norm_type><abstol>1e-9</abstol></convergence_criterion>
  <time_discretization><type>BackwardEuler</type></time_discretization>
  <time_stepping><type>FixedTimeStepping</type><t_initial>0</t_initial><t_end>0.2</t_end>
   <timesteps><pair><repeat>4</repeat><delta_t>0.05</delta_t></pair></timesteps></time_stepping></process></processes>
  <output><type>{form}</type><prefix>{name}_{form}</prefix>
   <hdf><number_of_files>1</number_of_files><chunk_size_bytes>65536</chunk_size_bytes></hdf>
   <timesteps><pair><repeat>4</repeat><each_steps>1</each_steps></pair></timesteps>
   <variables/></output></time_loop>
 <parameters>
  <parameter><name>begin</name><type>Function</type><expression>sin(3*x)+cos(2*y)*z</expression></parameter>
  <parameter><name>hot</name><type>Constant</type><value>2</value></parameter></parameters>
 <process_variables><process_variable><name>temperature</name><components>1</components><order>1</order>
  <initial_condition>begin</initial_condition>
  <boundary_conditions><boundary_condition><geometrical_set>box</geometrical_set><geometry>left</geometry>
   <type>Dirichlet</type><parameter>hot</parameter></boundary_condition></boundary_conditions>
 </process_variable></process_variables>
 <nonlinear_solvers><nonlinear_solver><name>picard</name><type>Picard</type><max_iter>10</max_iter>
  <linear_solver>cg</linear_solver></nonlinear_solver></nonlinear_solvers>
 <linear_solvers><linear_solver><name>cg</name><eigen><solver_type>CG</solver_type>
  <precon_type>DIAGONAL</precon_type><max_iteration_step>1000</max_iteration_step>
  <error_tolerance>1e-12</error_tolerance></eigen></linear_solver></linear_solvers>
</OpenGeoSysProject>
"""
GEOMETRY = """<?xml version="1.0"?>
<OpenGeoSysGLI><name>box</name>
 <points><point id="0" x="0" y="0" z="0"/><point id="1" x="0" y="1" z="0"/><point id="2" x="0" y="1" z="1"/>
  <point id="3" x="0" y="0" z="1"/></points>
 <surfaces><surface id="0" name="left"><element p1="0" p2="1" p3="2"/><element p1="0" p2="2" p3="3"/></surface>
 </surfaces></OpenGeoSysGLI>
"""


def run(program, *arguments):
    done = subprocess.run([BIN / program, *arguments], capture_output=True, text=True, check=False)
    if done.returncode:
        print(program, *arguments, done.stdout[-1500:], done.stderr[-500:], flush=True)


pathlib.Path("box.gml").write_text(GEOMETRY)
for name in ("hex", "prism", "tet"):
    run("generateStructuredMesh", "-e", name, "--lx", "1", "--ly", "1", "--lz", "1", "--nx", "6", "--ny", "5", "--nz",
        "4", "-o", f"{name}.vtu")
    for form in ("VTK", "XDMF"):
        pathlib.Path("project.prj").write_text(PROJECT.format(name=name, form=form))
        run("ogs", "project.prj")
run("createQuadraticMesh", "-i", "hex.vtu", "-o", "hex20.vtu")
run("createQuadraticMesh", "-i", "tet.vtu", "-o", "tet10.vtu")

/* Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause */
/* isotet for C, and for languages that call C: grids from files or arrays, isosurfaces as arrays. In the component io.
 *
 * Every function that can fail returns a status; isotet_last_error() has the sentence. Handles are made by functions
 * that take a pointer to them, and freed by theirs; freeing NULL does nothing. Functions may be called from many
 * threads, but one handle of a session by one thread at a time. Nothing is printed, and nothing is thrown.
 *
 * The binary interface stays: functions, their parameters and the order of members; structs grow at their end, and
 * `size` tells how much of one the caller knows. */
#ifndef ISOTET_ISOTET_H
#define ISOTET_ISOTET_H

#include <stddef.h>
#include <stdint.h>

#include <isotet/export.hpp>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum isotet_status {
    ISOTET_OK = 0,
    ISOTET_INVALID_ARGUMENT = 1, /* the caller: an option or a call is wrong */
    ISOTET_INVALID_DATA = 2,     /* a grid, a field or the content of a file breaks a rule */
    ISOTET_FILE = 3,             /* a file cannot be found, opened or recognized */
    ISOTET_OUT_OF_MEMORY = 4,
    ISOTET_CANNOT_WRITE = 5,
    ISOTET_NO_DEVICE = 6,
    ISOTET_DEVICE_FAILED = 7,
    ISOTET_SYSTEM = 8,
    ISOTET_CANCELLED = 9,
    ISOTET_INTERNAL = 10
} isotet_status;

typedef enum isotet_type {
    ISOTET_INT8 = 0,
    ISOTET_UINT8 = 1,
    ISOTET_INT16 = 2,
    ISOTET_UINT16 = 3,
    ISOTET_INT32 = 4,
    ISOTET_UINT32 = 5,
    ISOTET_INT64 = 6,
    ISOTET_UINT64 = 7,
    ISOTET_FLOAT32 = 8,
    ISOTET_FLOAT64 = 9
} isotet_type;

/* Rows of `columns` scalars, one row after another. No array: `rows` is 0.
 * Given to isotet, the memory stays the caller's and unchanged until `release` is called with `context`, by any thread,
 * when nothing uses it any more, also where the call fails; without `release`, as long as any handle made of it. Handed
 * out by isotet, it lives as long as its handle, and `release` is NULL. */
typedef struct isotet_array {
    const void* data;
    isotet_type type;
    uint64_t rows;
    uint64_t columns;
    void (*release)(void* context);
    void* context;
} isotet_array;

typedef struct isotet_grid isotet_grid;
typedef struct isotet_session isotet_session;
typedef struct isotet_surface isotet_surface;

/* "0.1.0" */
ISOTET_API const char* isotet_version(void);

/* The sentence of the last call of this thread that failed: what, the value seen, the rule. Until its next failure. */
ISOTET_API const char* isotet_last_error(void);

/* ---- Grids ---- */

/* Reads a file of any format that `isotet formats` lists.
 * `step`  from 0; ISOTET_FIRST_STEP */
#define ISOTET_FIRST_STEP UINT64_MAX
ISOTET_API isotet_status isotet_grid_read(const char* path, uint64_t step, int threads, isotet_grid** grid);

/* A grid of arrays, which are shared.
 * `points`        float32 or float64, 3 columns
 * `connectivity`  32- or 64-bit integers: the corners of all cells, one cell after another, in VTK's order
 * `offsets`       32- or 64-bit integers, one more than there are cells: where each cell's corners start; or none: all
 *                 cells are of `cell_type`
 * `types`         uint8, one a cell, VTK's numbers (10 tetrahedron, 12 hexahedron, 13 wedge, 14 pyramid, ...); or none
 * `cell_type`     where there are no types */
ISOTET_API isotet_status isotet_grid_create(const isotet_array* points, const isotet_array* connectivity,
                                            const isotet_array* offsets, const isotet_array* types, uint8_t cell_type,
                                            isotet_grid** grid);

/* Adds a field, one row a point or a cell, in place of one of that name.
 * `of_cells`  0: of points */
ISOTET_API isotet_status isotet_grid_add_field(isotet_grid* grid, const char* name, int of_cells,
                                               const isotet_array* values);

ISOTET_API uint64_t isotet_grid_cells(const isotet_grid* grid);
ISOTET_API void isotet_grid_points(const isotet_grid* grid, isotet_array* points);

/* How many fields, and the name of one; NULL where there are fewer. */
ISOTET_API uint64_t isotet_grid_fields(const isotet_grid* grid, int of_cells);
ISOTET_API const char* isotet_grid_field_name(const isotet_grid* grid, int of_cells, uint64_t number);

/* Sessions that were made of the grid go on. */
ISOTET_API void isotet_grid_free(isotet_grid* grid);

/* ---- Isosurfaces ---- */

typedef enum isotet_normals {
    ISOTET_NO_NORMALS = 0,
    ISOTET_GRADIENT_NORMALS = 1, /* one a vertex, of the field */
    ISOTET_FACE_NORMALS = 2,     /* one a triangle */
    ISOTET_VERTEX_NORMALS = 3    /* one a vertex, the mean of its triangles' */
} isotet_normals;

/* Called with a word for the step and the fraction done, 0 to 1, by any thread, one call at a time. Not 0 cancels. */
typedef int (*isotet_progress)(void* context, const char* step, double fraction);

typedef struct isotet_options {
    size_t size;           /* sizeof(isotet_options); isotet_default_options() sets all members */
    int threads;           /* 0: all */
    isotet_normals normals;
    int float64;           /* not 0: positions and values in double */
    int edge_ends;         /* not 0: ISOTET_EDGE_ENDS and ISOTET_EDGE_WEIGHTS */
    int source_cells;      /* not 0: ISOTET_SOURCE_CELLS */
    int split_cells;       /* not 0: hexahedra, wedges and pyramids as tets */
    uint64_t surfaces;     /* how many will be asked for; 0: not known */
    isotet_progress progress; /* or NULL */
    void* progress_context;
} isotet_options;

ISOTET_API void isotet_default_options(isotet_options* options);

/* A session: keeps what the next isovalue, field or time step can use.
 * `field`    its name, "U:mag", or an expression of fields (docs/expressions.md); NULL: the only one there is
 * `carried`  names of fields of the grid that surfaces have, too, `carried_count` of them; may be NULL
 * `options`  or NULL */
ISOTET_API isotet_status isotet_session_create(const isotet_grid* grid, const char* field, const char* const* carried,
                                               uint64_t carried_count, const isotet_options* options,
                                               isotet_session** session);

/* Another grid, field or time step: what is the same as before is found out and not packed again. */
ISOTET_API isotet_status isotet_session_set(isotet_session* session, const isotet_grid* grid, const char* field,
                                            const char* const* carried, uint64_t carried_count);

/* The range of the field's finite values; lower > upper where there is none. */
ISOTET_API isotet_status isotet_session_range(isotet_session* session, double* lower, double* upper);

/* `surfaces`  room for `count` handles; untouched where the call fails */
ISOTET_API isotet_status isotet_session_extract(isotet_session* session, const double* isovalues, uint64_t count,
                                                isotet_surface** surfaces);

/* Surfaces that it made stay. */
ISOTET_API void isotet_session_free(isotet_session* session);

/* ---- Surfaces ---- */

typedef enum isotet_surface_part {
    ISOTET_POSITIONS = 0,    /* V x 3, float32 or float64 */
    ISOTET_TRIANGLES = 1,    /* F x 3, uint32 or uint64: vertices, counter-clockwise seen from higher values */
    ISOTET_NORMALS = 2,      /* V x 3 or F x 3, float32, towards higher values */
    ISOTET_EDGE_ENDS = 3,    /* V x 2, int64: points of the grid that the vertex is between, the one below first */
    ISOTET_EDGE_WEIGHTS = 4, /* V: 0 at the first end, 1 at the second */
    ISOTET_SOURCE_CELLS = 5  /* F, int64: cells of the grid */
} isotet_surface_part;

/* No array where the session's options do not ask for it. */
ISOTET_API isotet_status isotet_surface_array(const isotet_surface* surface, isotet_surface_part part,
                                              isotet_array* array);

/* A carried field. */
ISOTET_API isotet_status isotet_surface_field(const isotet_surface* surface, const char* name, isotet_array* values);

ISOTET_API double isotet_surface_area(const isotet_surface* surface);

/* The ending chooses the format: .vtp, .ply, .stl, .obj, .glb, ... Written beside and renamed. */
ISOTET_API isotet_status isotet_surface_write(const isotet_surface* surface, const char* path);

ISOTET_API void isotet_surface_free(isotet_surface* surface);

#ifdef __cplusplus
}
#endif

#endif

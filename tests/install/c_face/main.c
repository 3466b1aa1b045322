/* Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause */
/* Two tets of the caller's arrays by the C functions: a surface, its arrays, what is wrong, and memory given back. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <isotet/isotet.h>

static int released = 0;

static void release(void* context) { released += *(const int*)context; }

static int stop_at_once(void* context, const char* step, double fraction) {
    (void)context, (void)step, (void)fraction;
    return 1;
}

static int fail(const char* what) {
    fprintf(stderr, "%s: %s\n", what, isotet_last_error());
    return 1;
}

int main(void) {
    static const float points[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
    static const int32_t corners[] = {0, 1, 2, 3, 1, 2, 3, 4};
    static const double values[] = {0, 1, 1, 1, 3}, speeds[] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 3, 4, 0, 6, 8, 0};
    static const int one = 1;
    isotet_array point_array = {points, ISOTET_FLOAT32, 5, 3, release, (void*)&one};
    isotet_array corner_array = {corners, ISOTET_INT32, 8, 1, NULL, NULL};
    isotet_array value_array = {values, ISOTET_FLOAT64, 5, 1, NULL, NULL};
    isotet_array speed_array = {speeds, ISOTET_FLOAT64, 5, 3, NULL, NULL};
    isotet_grid* grid = NULL;
    if (isotet_grid_create(&point_array, &corner_array, NULL, NULL, 10, &grid)) return fail("grid");
    if (isotet_grid_add_field(grid, "T", 0, &value_array) || isotet_grid_add_field(grid, "U", 0, &speed_array))
        return fail("field");
    if (isotet_grid_cells(grid) != 2 || isotet_grid_fields(grid, 0) != 2 || isotet_grid_fields(grid, 1) != 0 ||
        strcmp(isotet_grid_field_name(grid, 0, 1), "U") != 0 || isotet_grid_field_name(grid, 0, 2) != NULL)
        return fail("what the grid has");

    isotet_options options;
    isotet_default_options(&options);
    options.edge_ends = options.source_cells = 1;
    options.normals = ISOTET_VERTEX_NORMALS;
    const char* carried[] = {"U", "mag(U)"};
    isotet_session* session = NULL;
    if (isotet_session_create(grid, "T", carried, 2, &options, &session)) return fail("session");
    isotet_grid_free(grid);
    double lower = 0, upper = 0;
    if (isotet_session_range(session, &lower, &upper) || lower != 0 || upper != 3) return fail("range");
    const double isovalues[] = {0.5, 2};
    isotet_surface* surfaces[2] = {NULL, NULL};
    if (isotet_session_extract(session, isovalues, 2, surfaces)) return fail("extract");

    isotet_array positions, triangles, ends, normals, carried_speed;
    if (isotet_surface_array(surfaces[0], ISOTET_POSITIONS, &positions) ||
        isotet_surface_array(surfaces[0], ISOTET_TRIANGLES, &triangles) ||
        isotet_surface_array(surfaces[0], ISOTET_EDGE_ENDS, &ends) ||
        isotet_surface_array(surfaces[0], ISOTET_NORMALS, &normals) ||
        isotet_surface_field(surfaces[0], "mag(U)", &carried_speed))
        return fail("arrays");
    if (positions.rows != 3 || positions.columns != 3 || positions.type != ISOTET_FLOAT32 || triangles.rows != 1 ||
        triangles.type != ISOTET_UINT32 || ends.rows != 3 || ends.columns != 2 || normals.rows != 3 ||
        carried_speed.rows != 3)
        return fail("shapes");
    if (fabs(isotet_surface_area(surfaces[0]) - sqrt(3.0) / 8) > 1e-6) return fail("area");
    if (isotet_surface_write(surfaces[1], "c_face.ply")) return fail("write");

    if (isotet_session_create(NULL, "T", NULL, 0, NULL, &session) != ISOTET_INVALID_ARGUMENT ||
        strcmp(isotet_last_error(), "grid is NULL") != 0)
        return fail("an error that was not told");
    if (isotet_grid_read("is not there.vtu", ISOTET_FIRST_STEP, 1, &grid) != ISOTET_FILE) return fail("no file");
    if (isotet_surface_write(surfaces[1], "no/such/folder.ply") == ISOTET_OK) return fail("no folder");
    isotet_surface_free(surfaces[0]);
    isotet_surface_free(surfaces[1]);
    isotet_session_free(session);
    if (released != 1) return fail("the points were not given back");

    /* Memory is given back where the call fails, too. */
    point_array.columns = 2;
    if (isotet_grid_create(&point_array, &corner_array, NULL, NULL, 10, &grid) != ISOTET_INVALID_DATA || released != 2)
        return fail("points of two columns");
    point_array.columns = 3;
    if (isotet_grid_create(&point_array, &corner_array, NULL, NULL, 10, &grid) ||
        isotet_grid_add_field(grid, "T", 0, &value_array))
        return fail("grid again");
    options.progress = stop_at_once;
    session = NULL;
    isotet_status status = isotet_session_create(grid, "T", NULL, 0, &options, &session);
    if (!status) status = isotet_session_extract(session, isovalues, 1, surfaces);
    if (status != ISOTET_OK && status != ISOTET_CANCELLED) return fail("cancelling");
    isotet_session_free(session);
    isotet_grid_free(grid);
    isotet_grid_free(NULL);
    printf("isotet %s from C\n", isotet_version());
    return released == 3 ? 0 : fail("the points were not given back at the end");
}

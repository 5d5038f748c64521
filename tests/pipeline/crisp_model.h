// A grammar's model with its crisp mesh, for tests of what is done to meshes.
// Enters: the text of a grammar. Leaves: model, grid and mesh. Assumes a text without errors.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <utility>

#include "grammar/pipeline/grids.h"
#include "grammar/pipeline/load.h"
#include "grammar/pipeline/mesh_edits.h"
#include "grammar/pipeline/meshing.h"

namespace sgm::pipeline {

struct CrispModel {
    Model model;
    mesh::Grid grid;
    mesh::Mesh mesh;

    /// `edited` with this model's field; the mesh is moved from.
    Result<mesh::Mesh> edit(const MeshEdits& edits, Context& context) {
        return edited(std::move(mesh), edits, {model.tape, mesh::Surface::Crisp, grid.cell_m}, context);
    }
};

/// A file as text.
inline std::string fileText(const std::string& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

/// A text with errors fails the test, and the program ends.
inline Model modelOf(const std::string& text, Context& context) {
    syntax::Diagnostics problems;
    const auto grammar = load("test.sgm", text, problems);
    EXPECT_TRUE(grammar) << text;
    auto model = makeModel(grammar, *optionsFor(*grammar, {}), context);
    EXPECT_TRUE(model.ok()) << text;
    return std::move(*model);
}

/// The model as one whose mesh isn't made in the axes of its walls, but across the grid, as those of parts are that
/// stand otherwise than most.
inline Model acrossGrid(Model model) {
    model.keepsAxes = true;
    return model;
}

/// `resolution` cells along the longest side, halved up to `halvings` times around thin parts, to so many triangles; on
/// two threads.
inline MeshedModel meshed(const Model& model, int resolution, int halvings = 3,
                          size_t triangles = mesh::PolygonizeOptions{}.halvedTriangles, bool halvesAll = true) {
    Context context{nullptr, 2};
    auto made = makeMesh(
        model, gridOf(model, resolution),
        {.surface = mesh::Surface::Crisp, .halvings = halvings, .halvesAll = halvesAll, .halvedTriangles = triangles},
        context);
    EXPECT_TRUE(made.ok());
    return std::move(*made);
}

/// A mesh some of whose cells are halved, never all of them.
inline MeshedModel meshedInPart(const Model& model, int resolution) {
    return meshed(model, resolution, 3, mesh::PolygonizeOptions{}.halvedTriangles, false);
}

/// The same of any model.
inline CrispModel crispModel(Model model, int resolution, Context& context, int halvings = 3) {
    const mesh::Grid grid = gridOf(model, resolution);
    auto meshed = makeMesh(model, grid, {.surface = mesh::Surface::Crisp, .halvings = halvings}, context);
    EXPECT_TRUE(meshed.ok());
    return {std::move(model), grid, std::move(meshed->mesh)};
}
/// The same with the model of a text. A text with errors fails the test, and the program ends.
inline CrispModel crispModel(const std::string& text, int resolution, Context& context, int halvings = 3) {
    return crispModel(modelOf(text, context), resolution, context, halvings);
}

}  // namespace sgm::pipeline

// A model baked cell by cell into a folder: stateless tasks, whose bytes depend on the place alone.
// Enters: a model whose objects stand apart, a folder, which share of the cells is asked for. Leaves: a library of
// objects, a file a cell, and a note beside each, from which tiles::merge makes a tileset. Assumes that several tasks
// may work on the same folder at once, and that any of them may be killed at any moment.
#pragma once

#include <filesystem>
#include <functional>

#include "grammar/pipeline/placed_models.h"
#include "grammar/pipeline/scene.h"
#include "modeler/tiles/tileset.h"

namespace sgm::pipeline {

struct BakeRequest {
    std::filesystem::path folder;
    double side_m = 256;       ///< of the finest cells
    double cell_m = 2;         ///< of the ground's grid at the finest level; the side is a multiple of 32 of them
    double objectCell_m = .3;  ///< of the objects' grids
    int levels = 3;            ///< of detail: objects, coarser objects (where there are three or more), masses
    derive::Budget budget;
};

/// A bake that is under way.
class Bake {
public:
    /// Derives the objects and lays out the cells. Error::Usage for sizes that don't fit each other; those of
    /// PlacedModels. The model and the request have to outlive it.
    static Result<Bake> begin(const Model& model, const BakeRequest& request, Context& context);

    const tiles::BakePlan& plan() const { return plan_; }
    /// Numbers of those of `of` tasks whose cells aren't all done.
    std::vector<int> missing(int of) const;
    /// Makes the cells of a task that aren't done yet, and the objects of the library that they need; stage "bake".
    /// `told` is called after each cell.
    Status run(const tiles::Share& share, Context& context,
               const std::function<void(const tiles::Cell&, const tiles::CellFigures&)>& told = nullptr);

private:
    Bake(const Model& model, const BakeRequest& request, Context& context)
        : model_(model), request_(request), objects_(model.derivation, request.budget, context) {}
    Status layOut(Context& context);
    Result<std::string> libraryFile(uint32_t object, int level, Context& context);
    Status bakeObject(uint32_t object, int level, const std::filesystem::path& file, Context& context);
    Result<std::vector<tiles::GroundPiece>> ground(const tiles::Cell& cell, Context& context) const;
    Result<tiles::CellFigures> bakeCell(const tiles::Cell& cell, Context& context);
    /// Which detail of the library a level of cells shows.
    int detailOf(int level) const;

    const Model& model_;
    const BakeRequest& request_;
    PlacedModels objects_;
    std::vector<PlacedModels::Place> places_;
    std::map<tiles::Cell, std::vector<uint32_t>> placesOf_;  ///< by cell of level 0: indices into places_
    tiles::BakePlan plan_;
    tiles::Library library_;
};

}  // namespace sgm::pipeline

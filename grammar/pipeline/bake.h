// A model baked cell by cell into a folder: stateless tasks, whose bytes depend on the place alone.
// Enters: a model whose objects stand apart, a folder, which share of the cells is asked for. Leaves: a library of
// objects, a file a cell, and a note beside each, from which tiles::merge makes a tileset. Assumes that several tasks
// may work on the same folder at once, and that any of them may be killed at any moment.
#pragma once

#include <filesystem>
#include <functional>

#include "grammar/pipeline/baked_ground.h"
#include "grammar/pipeline/baked_objects.h"
#include "modeler/tiles/tileset.h"

namespace sgm::pipeline {

struct BakeRequest {
    std::filesystem::path folder;
    double side_m = 256;       ///< of the finest cells
    double cell_m = 2;         ///< of the ground's grid at the finest level; the side is a multiple of 32 of them
    double objectCell_m = .3;  ///< of the objects' grids
    int levels = 3;            ///< of detail: objects, coarser objects (where there are three or more), masses
    tiles::Packing packing = tiles::Packing::Meshopt;
    bool seeksThinParts = false;  ///< look at the first object of each start for parts that its cells lack
    derive::Budget budget;
};

/// Seconds that a task spent, by the wall.
struct BakeTimes {
    double ground = 0, objects = 0, cells = 0;
};

/// Called with a cell that was made.
using CellVisitor = std::function<void(const tiles::Cell&, const tiles::CellFigures&)>;

/// A bake that is under way.
class Bake {
public:
    /// Derives the objects and lays out the cells. Error::Usage for sizes that don't fit each other; those of
    /// PlacedModels. The model and the request have to outlive it.
    static Result<Bake> begin(const Model& model, const BakeRequest& request, Context& context);

    const tiles::BakePlan& plan() const { return plan_; }
    /// Numbers of those of `of` tasks whose cells aren't all done.
    std::vector<int> missing(int of) const;
    /// Makes a task's share of the library, then its cells that aren't done yet with the objects that they need and
    /// nobody has made; stages "objects" and "cells". `told` is called after each cell.
    Status run(const tiles::Share& share, Context& context, const CellVisitor& told = nullptr);
    /// Makes some of the plan's cells, by index, and what they need.
    Status runCells(const std::vector<size_t>& cells, Context& context, const CellVisitor& told = nullptr);
    const BakeTimes& times() const { return times_; }
    /// What the ground and the objects lack that this task made, where that is sought.
    std::vector<MeshWarning> warnings() const;

private:
    Bake(const Model& model, const BakeRequest& request, Context& context);
    Status layOut(Context& context);
    Status addGroundCells(std::vector<tiles::Cell>& cells) const;
    Status makeFolders() const;
    Status makeObjects(const tiles::Share& share, Context& context);
    Status makeObject(uint32_t object, int level, Context& context);
    Result<tiles::CellFigures> bakeCell(const tiles::Cell& cell, std::vector<tiles::SurfacePiece> ground,
                                        Context& context);
    /// Which detail of the library a level of cells shows.
    Detail detailOf(int level) const;

    const Model& model_;
    const BakeRequest& request_;
    std::unique_ptr<PlacedModels> objects_;
    BakedGround ground_;
    GroundParts parts_;
    BakedObjects library_;
    std::vector<PlacedModels::Place> places_;
    std::vector<uint32_t> used_;                             ///< objects that stand somewhere, in the library's order
    std::map<tiles::Cell, std::vector<uint32_t>> placesOf_;  ///< by cell of level 0: indices into places_
    tiles::BakePlan plan_;
    tiles::Library opened_;
    BakeTimes times_;
};

}  // namespace sgm::pipeline

// The model's own surface, cell by cell, on one grid for all cells of a level.
// Enters: a model, cells. Leaves: their triangles, whose borders are the neighbours' bit for bit. Assumes that a block
// of the grid is meshed the same in every task, which mesh::meshBlocks holds.
#pragma once

#include <map>
#include <vector>

#include "grammar/pipeline/ground_parts.h"
#include "grammar/pipeline/model.h"
#include "grammar/pipeline/square_tapes.h"
#include "modeler/mesh/subdivide.h"
#include "modeler/tiles/cell.h"
#include "modeler/tiles/surface_buffer.h"

namespace sgm::pipeline {

struct GroundRequest {
    double side_m = 256;  ///< of the finest cells
    double cell_m = 2;    ///< of the grid at the finest level, doubled from level to level
    int levels = 3;
};

/// A cell's blocks in a grid: columns [x, x + side) × [z, z + side).
struct BlockColumns {
    int x, z, side;
    bool has(int bx, int bz) const { return bx >= x && bx < x + side && bz >= z && bz < z + side; }
    /// Whether a region of `size` blocks touches them, or the ring below, which lends vertices.
    bool touches(int x0, int z0, int size) const {
        return x0 < x + side && x0 + size > x - 1 && z0 < z + side && z0 + size > z - 1;
    }
};

class BakedGround {
public:
    BakedGround(const Model& model, const GroundRequest& request);

    /// Error::Usage where the grid has more cells than can be counted and its cells are no power of two.
    Status check() const;
    /// Looks through the model once for what matters where, so that cells take no time and memory by its size.
    void prepare() { tapes_.cutWhole(); }
    /// The cells whose ground is made together: those of `cells` with the first one's level and parent, for what is
    /// around them is then meshed once. Cells of the coarsest level are made one at a time, for their tapes are long.
    std::vector<tiles::Cell> groupOf(const std::vector<tiles::Cell>& cells) const;
    /// The pieces of each, about its centre. Errors of mesh::subdivide and mesh::meshBlocks. Cells of the finest level
    /// are added to `parts`, unless it is null.
    Result<std::map<tiles::Cell, std::vector<tiles::SurfacePiece>>> make(const std::vector<tiles::Cell>& group,
                                                                         GroundParts* parts, Context& context);
    /// Where vertices of a cell's ground may lie once packed, about its centre: places that neighbours share.
    tiles::QuantizationGrid placesOf(const tiles::Cell& cell) const;
    /// Edge of a cell of the grid, metres.
    double pitch_m(int level) const { return request_.cell_m * (1 << level); }

private:
    Result<std::vector<mesh::Block>> findBlocks(const std::vector<tiles::Cell>& group,
                                                const std::vector<BlockColumns>& cells, const mesh::Grid& grid,
                                                Context& context, mesh::Counts& counts);
    /// The model's tape around a cell, valid until the next call.
    const eval::Tape& tapeOf(const tiles::Cell& cell);
    /// Closes the gaps to neighbours of other levels, by strips on the cell's borders.
    void addSkirts(const tiles::Cell& cell, std::vector<tiles::SurfacePiece>& pieces);
    mesh::Grid gridOver(const std::vector<tiles::Cell>& group, Vec3i& corner) const;

    const Model& model_;
    const GroundRequest request_;
    SquareTapes tapes_;
    eval::Workspace workspace_;             ///< kept from group to group: its memory is large
    std::vector<eval::Workspace> scratch_;  ///< of mesh::subdivide, likewise
};

}  // namespace sgm::pipeline

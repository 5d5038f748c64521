// A field on the GPU, ready for rays: one fixed shader interprets the shortened tapes of cells (viewer/cells.h), so that
// a new field costs an upload and no compile.
// Enters: a tape, bounds and materials. Leaves: what each ray met and its light. Assumes a current GL 4.3 context for
// all but `prepareField`.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "modeler/core/progress.h"
#include "modeler/eval/glsl.h"
#include "viewer/cells.h"
#include "viewer/gpu.h"
#include "viewer/pixels.h"

namespace sgm::viewer {

/// Everything about a field that needs no GPU, so that any thread can make it.
struct PreparedField {
    eval::Tape tape;
    Box3f bounds;                      ///< of the solid, metres
    Box3f box;                         ///< what the cells cover
    CellTree tree;
    std::vector<uint32_t> words, nodes;  ///< the cells' tapes and the tree, as the shaders read them
    uint32_t registers = 0;              ///< of the longest tape
    std::vector<Material> materials;
    std::vector<uint32_t> materialOf;  ///< by OriginId
};

/// Cuts space into cells. Error::Cancelled when `progress` says so.
Result<PreparedField> prepareField(const eval::Tape& tape, const Box3f& bounds, const Provenance& provenance, int threads,
                                   Progress* progress);

/// The two shaders, kept while they know every op of the fields that come.
struct FieldPrograms {
    Program trace, shade;
    uint32_t registers = 0;
    eval::OpSet ops;

    /// True when the field can be drawn without a compile.
    bool cover(const PreparedField& field) const;
};
/// Programs for this field and those that `before` covers (null: none): `before` itself where it covers the field.
Result<std::shared_ptr<const FieldPrograms>> programsFor(const PreparedField& field,
                                                         std::shared_ptr<const FieldPrograms> before);

enum class HitKind { Sky, Object, Ground };

/// What a batch of rays met, an entry a job.
struct Rays {
    std::vector<std::array<float, 4>> hits;      ///< position in metres (for the sky: direction), HitKind
    std::vector<std::array<float, 4>> surfaces;  ///< unit normal, share of open sky 0 … 1; 0 for the sky
    std::vector<std::array<float, 4>> colors;    ///< display light 0 … 1, linear, and 1
    std::vector<OriginId> origins;               ///< of objects, else 0

    uint32_t evaluations[2] = {0, 0};            ///< of the field on the GPU: for hits, for normals and light
    uint32_t instructions = 0;                   ///< of the tapes they ran

    HitKind kind(size_t i) const { return static_cast<HitKind>(static_cast<int>(hits[i][3])); }
    Vec3f position(size_t i) const { return {hits[i][0], hits[i][1], hits[i][2]}; }
};

/// A prepared field in GPU memory.
class FieldScene {
public:
    /// `programs` must cover the field.
    FieldScene(PreparedField field, std::shared_ptr<const FieldPrograms> programs, int threads);
    /// Draws one ray from anywhere: drivers finish compiling at a program's first draw.
    Status warmUp();
    /// Sets camera, picture size and ground. `fine` scales how exactly surfaces are found: above 1 finer than the
    /// picture's pixels ask for.
    void look(const PictureOptions& options, double fine = 1);
    /// Traces and lights up to 2¹⁸ jobs of the picture last looked at, in pieces of some 15 ms.
    Result<Rays> draw(std::span<const Job> jobs, Progress* progress);
    /// Without `words` and `nodes`, which only the GPU has from now on.
    const std::shared_ptr<const PreparedField>& field() const { return field_; }

private:
    std::vector<OriginId> originsOf(const Rays& rays) const;

    std::shared_ptr<const PreparedField> field_;
    std::shared_ptr<const FieldPrograms> programs_;
    TexelBuffer words_, single_, nodes_;  // the tapes by instruction and by word; the tree
    Buffer materials_;
    int threads_;
    size_t tracePiece_ = 2048, shadePiece_ = 2048;  ///< jobs a dispatch, by the time the last ones took
};

/// Runs `program` over jobs [0, count), which it reads as firstJob and jobCount, in dispatches of `piece` jobs: some 15 ms
/// each, by the time the last ones took.
Status runInPieces(const Program& program, size_t count, size_t& piece, Progress* progress);

/// The most jobs of one FieldScene::draw.
inline constexpr size_t mostJobs = size_t(1) << 18;

}  // namespace sgm::viewer

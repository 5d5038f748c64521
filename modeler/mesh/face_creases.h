// Creases and borders on the faces of cells: where the surface's curve in a face goes from one smooth piece to another.
// After Ho, Wu, Chen, Chuang, Ouhyoung, "Cubical Marching Squares", 2005, with pieces known by their labels instead of
// guessed from normals.
// Enters: segments of marching squares whose ends have different labels. Leaves: the points between the pieces. Assumes
// ends, face and tape alone decide, so that the two cells around a face, also in different blocks, find the same bits.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "modeler/mesh/face_axes.h"

namespace sgm::mesh {

/// A point where two pieces meet.
struct Break {
    Vec3f at;             ///< metres, inside the face
    Vec3f crossing;       ///< where the pieces cross in the plane of the face: `at`, or outside the face
    PiecePoint sides[2];  ///< before and after it on the way of the segment
};

/// A segment of marching squares.
struct FaceSegment {
    Vec3i face;         ///< low corner of the cell face, counted in the grid
    int axis = 0;       ///< the normal of the face
    bool alone = true;  ///< the face has no other segment
    size_t brick = 0;   ///< one that the face belongs to
    PiecePoint ends[2];
    float values[2] = {};  ///< of the field at the ends
    uint32_t firstBreak = 0, breaks = 0;
};

/// One worker's solver, reused from block to block.
class FaceCreases {
public:
    /// Finds the breaks of the segments from `first` on, listed in their order, after those found for the others
    /// before; `first` 0: anew. Returns how often the field was evaluated.
    uint64_t solve(const BlockTapes& tapes, const Grid& grid, eval::Workspace& workspace,
                   std::vector<FaceSegment>& segments, size_t first);
    const std::vector<Break>& breaks() const { return breaks_; }

private:
    static constexpr int mostSplits = 3;             ///< pieces found between the ends of a segment
    static constexpr float probeShare = 0.0625f;     ///< of the way to an end, where its piece is looked at
    static constexpr float mergedShare = 0x1.0p-8f;  ///< of a cell, within which two breaks are one
    enum class State : uint8_t { Ends, Middle, Third, Crease, Below, Beside, Border, Done };
    /// Two neighbouring pieces of a segment, and the search for the point between them.
    struct Gap {
        uint32_t segment = 0;
        int32_t next = -1;  ///< the gap after it on the segment
        State state = State::Ends;
        uint8_t rounds = 0, splits = 0;
        struct {
            uint8_t below = 0, beside = 0;                    ///< left, and taken
            bool isBorder = false;                            ///< whether it was searched as one
        } looks;                                              ///< at a border's wall
        std::array<float, 2> shares{probeShare, probeShare};  ///< of the way to a and b, where these are looked for
        PiecePoint a, b;                                      ///< where the pieces are known
        LinearField nearA, nearB;  ///< their fields where they were looked at last, nearer to the crease
        LinearField wall;  ///< between two parts, looked at below the surface; a third piece, looked at amid the gap
        Vec3f at;
        Vec3f crossing;       ///< of the two lines, before it was moved into the face
        bool leaves = false;  ///< the crossing lies outside the face, and both pieces were found there
    };
    uint64_t solveOpen(const std::vector<FaceSegment>& segments, eval::Workspace& workspace);
    void ask(const FaceSegment& segment, const Gap& gap);
    void take(const FaceSegment& segment, uint32_t gap, size_t sample);
    void takeEnds(const FaceSegment& segment, Gap& gap, const PiecePoint& a, const PiecePoint& b);
    void takeMiddle(const FaceSegment& segment, Gap& gap, size_t sample);
    void takeThird(const FaceSegment& segment, uint32_t gap, size_t sample);
    void takeProbes(const FaceSegment& segment, uint32_t gap, size_t sample);
    std::pair<PiecePoint, bool> inBracket(const FaceSegment& segment, const PiecePoint& before, double most,
                                          size_t sample) const;
    void takeParts(const FaceSegment& segment, uint32_t gap, size_t sample);
    void aim(const FaceSegment& segment, Gap& gap);
    void projectOntoCrease(Gap& gap, Vec3f from) const;
    static void searchBorder(Gap& gap, bool isFlat = false);
    void askForBorder(const FaceSegment& segment, const Gap& gap);
    void takeBorder(const FaceSegment& segment, uint32_t gap, size_t sample);
    bool takeBelow(const FaceSegment& segment, Gap& gap, size_t sample);
    bool takeBeside(const FaceSegment& segment, Gap& gap, size_t sample);
    double besideReach(const Gap& gap) const;
    bool meetWall(const FaceSegment& segment, Gap& gap, const LinearField& surface) const;
    uint64_t searchSmoothBorders(const std::vector<FaceSegment>& segments, eval::Workspace& workspace);
    uint64_t confirmCrossings(const std::vector<FaceSegment>& segments, eval::Workspace& workspace);
    uint64_t lookBesideTies(const std::vector<FaceSegment>& segments, eval::Workspace& workspace);
    void split(uint32_t gap, const PiecePoint& between);
    Vec3f inFace(const FaceSegment& segment, Vec3f p) const;
    bool moveAlongLine(const FaceSegment& segment, PiecePoint& piece) const;
    bool mayLieAt(const FaceSegment& segment, Vec3f p) const;
    void arrange(const FaceSegment& segment);
    void separate(std::vector<FaceSegment>& segments, size_t first);

    bool isKnown(float value) const { return value >= -limit_ && value <= limit_; }

    const Grid* grid_ = nullptr;
    float limit_ = 0;  ///< values beyond it hang on the block's tape
    std::vector<Gap> gaps_;
    std::vector<uint32_t> open_, next_;
    BlockTapes tapes_;
    PieceSamples samples_;
    std::vector<Break> breaks_, chain_;
};

}  // namespace sgm::mesh

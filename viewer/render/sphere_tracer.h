// Steps of a ray through cells, one evaluation of the field at a time: `ask` goes on to the next place where the field
// must be evaluated, `answer` takes its value there. So many rays walk together, and the field is evaluated for all of
// them at once. Enters: a prepared field, rays. Leaves: where they hit, or how much of a disc of light they see. The
// same steps as trace.comp.glsl and surface.comp.glsl take, which say where they come from.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "viewer/render/prepared_field.h"
#include "viewer/render/tracer.h"

namespace sgm::render {

/// A place where the field must be evaluated, by a cell's tape.
struct Question {
    Vec3f place;
    uint32_t tape;
};

struct Cell {
    CellState state = CellState::Outside;  ///< never Node
    uint32_t tape = 0;                     ///< of a near cell
    Vec3f low;                             ///< metres
    float edge = 0;                        ///< metres
    float least = 0;                       ///< of the field in the cell
    bool doubtful = false;                 ///< the field may be small where no surface is near (SmallValues)
    bool holds(Vec3f p) const {
        return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x < low.x + edge && p.y < low.y + edge &&
               p.z < low.z + edge;
    }
    /// Distance along a ray from p to a little beyond where it leaves the cell.
    float exit(Vec3f p, Vec3f inverseDirection) const;
};

/// A prepared field as rays see it from one side of its surface.
struct CellSpace {
    const PreparedField& field;
    float side;  ///< 1, or −1 to stand inside the solid
    float inverseLipschitz = field.inverseLipschitz();
    float margin = field.tree.margin;
    float finestPerMetre = float(1 << (2 * CellTree::surfaceDepth)) / field.tree.edge;
    float size = length(field.bounds.size());  ///< metres

    Cell cellAt(Vec3f p) const;
    /// What steps and offsets are shares of, metres: the scene, or as much of it as a picture shows whose pixels are so
    /// wide (shownSize in surface.comp.glsl).
    float shownSize(float pixel) const { return std::min(size, 1500 * pixel); }
    /// Whether a guess hits the surface: by the field there times `side`, and the picture's pixel there, metres. Inside
    /// it may lie behind another face.
    bool surfaceAt(float value, float pixel) const {
        const float least = 2e-6f * size;
        return value > -std::max(0.05f * pixel, least) && value < std::max(0.35f * pixel, least);
    }
    /// The span of a ray inside the box; empty (x > y) when it misses it.
    std::array<float, 2> span(Vec3f origin, Vec3f inverseDirection) const;
};

/// 1/d by components, without infinities.
Vec3f inverseOf(Vec3f direction);

/// Whether solid lies behind a small value of the field. Inside a union of cutters, and where cutters touch, the field
/// is small with no solid near: a bound that is true and tells nothing. So the surface is looked for where the value
/// and its slope put it, by Newton's steps, and solid a little behind it.
class SolidProbe {
public:
    /// `value`: of the field at `place`, times the space's side. `into`: how deep the solid must reach, metres.
    /// `direction`: of a ray that would meet it, tried first; 0 for none.
    void begin(Vec3f place, float value, float into, Vec3f direction = {});
    /// False once it is known.
    bool ask(const CellSpace& space, Question& question);
    void answer(const CellSpace& space, float value);
    bool found() const { return found_; }

private:
    static constexpr int alongRay = -1, atFoot = 3, rounds = 3;
    void findFoot();

    Vec3f place_, foot_, slope_;
    float value_ = 0, into_ = 0;
    int step_ = 0, round_ = 0;
    bool running_ = false, found_ = false;
    Cell cell_;
};

/// How far a place is from solid, as far as that matters, where the field's own value is in doubt. What is looked for
/// is the share of light that gets to a surface, so it changes gradually from place to place: the larger the field
/// behind the surface that its value tells of, the less that surface counts.
class ClearanceWalk {
public:
    /// `value`: of the field at `place`, times the space's side; `enough`: more doesn't matter. Metres.
    ClearanceWalk(const CellSpace& space, Vec3f place, float value, float enough, float pixel);
    /// False once it is known. Nine questions at most.
    bool ask(const CellSpace& space, Question& question);
    void answer(const CellSpace& space, float value);
    /// Metres: `value` where there is solid behind it, at most `enough`.
    float clearance() const { return value_; }

private:
    /// Three differences, places behind the surface, and one as far away from it as matters.
    static constexpr int firstBehind = 3, aside = 8;
    Vec3f placeOfStep() const;

    Vec3f place_, slope_;
    float value_, enough_, into_;
    float depth_;     // how far behind the surface the next step looks, metres
    float open_ = 1;  // the share of the surface that isn't there
    int step_ = 0;
    Cell cell_;
};

/// The line that a walk goes along.
struct WalkLine {
    Vec3f origin, direction, inverse;
};

/// The first surface along a ray.
class SphereTracer {
public:
    /// `pixelAngle`: radians a pixel; hits are exact to some third of one.
    SphereTracer(const CellSpace& space, Vec3f origin, Vec3f direction, float pixelAngle, const Ray& ray);
    /// False when the walk has ended.
    bool ask(const CellSpace& space, Question& question);
    /// The field's value, times the space's side.
    void answer(const CellSpace& space, float value);
    /// Distance along the ray, metres; −1 when there is no surface.
    float found() const { return found_; }
    /// Distance along the ray up to which the cone beside it holds no surface, metres.
    float freeBeside() const { return freeBeside_; }

private:
    /// What may be stepped over unseen at t, metres.
    float gap(float t) const { return 0.3f * precision_.pixelAngle * t; }
    /// The cone beside the ray holds no surface between two places of it.
    void setFree(float from, float to);
    /// Takes what the probe behind a small value found: the surface, or nothing, and the walk goes on behind it.
    void settleDoubt();

    /// How near a surface a hit lies: metres at the eye, radians along the ray.
    struct Precision {
        float tolerance, angle, pixelAngle;
    };
    /// A small value, where the field may say nothing of a surface.
    struct SmallValue {
        bool active = false;
        float candidate = -1;
        SolidProbe probe;
    };
    WalkLine line_;
    Precision precision_;
    float t_, end_, free_ = 0, slope_ = -1, stride_ = 0, found_ = -1;
    float beside_, freeBeside_;
    int steps_ = 0;
    bool ended_ = false;
    SmallValue doubt_;
    Cell cell_;
};

/// How clear of solid a disc of light is that a place sees: along the ray to its middle, the least distance to solid in
/// units of the disc's radius there. What a solid hides of the disc no one ray tells, for depth in a thin body is no
/// distance to its outline: a disc that is neither whole nor hidden for certain is looked at by its parts.
class DiscWalk {
public:
    /// Parts of a disc beside its middle, a third of a turn apart; how far from its middle theirs lie, and their
    /// radius, both in radii of the disc. The part in the middle is what the ray there tells.
    static constexpr int parts = 3;
    static constexpr float partOffset = 0.4f, partRadius = 0.6f;
    /// A disc of sky is so wide that it needn't be known as well as the sun's.
    enum class Of { Disc, Part, Sky };

    /// `radius`: half the angle of the disc or its part, radians; `pixel`: of the picture at the place, metres; `from`:
    /// the way known to be free, metres.
    DiscWalk(const CellSpace& space, Vec3f place, Vec3f direction, float radius, float pixel, Of of = Of::Disc,
             float from = 0);
    bool ask(const CellSpace& space, Question& question);
    void answer(const CellSpace& space, float value);
    /// From −1, hidden by far, to 1, free; negative where the ray meets solid. Of a part only what is above 0 counts.
    float clearance() const { return clearance_; }
    /// Part of the disc may be hidden, by what is far enough away for its soft edge to be seen.
    bool isPartial() const { return soft_ && clearance_ > hidden && clearance_ < 1; }
    /// The way along which all of the disc is free, metres.
    float freeUntil() const { return freeUntil_; }

private:
    static constexpr float hidden = -0.9f;
    /// Takes what the probe behind a small value found; false where the way must be walked again, every value probed.
    bool settleDoubt();
    /// A disc this small a share of which is free, by a value that may say nothing.
    void doubt(Vec3f place, float value, float clearance);
    /// How near solid must be to tell something new, in radii of the disc.
    float matters() const { return soft_ ? std::max(clearance_, 0.0f) : 1; }
    /// Whether nothing nearer than `matters_m` to the way of the stride can have been missed, where the field is `next`
    /// behind it; metres.
    bool sawAll(float next, float matters_m) const;
    /// Goes back to the start.
    void restart();
    /// True where the last sample is nearer to solid than the one before it and this one; the next sample is then at
    /// the minimum of a parabola through the three. The least distance says how dark the shadow is, and that of the
    /// steps alone would show as bands.
    bool turnsBack(float value, float disc);

    /// Values that may say nothing of a surface.
    struct Doubts {
        bool careful = false, any = false, probing = false;
        Vec3f leastPlace;
        float leastValue = 0, probedClearance = 1;
        SolidProbe probe;
    };
    /// The values at the last place and the one before, and how far apart these are; metres, 0 before there are any.
    struct Passed {
        float value = 0, before = 0, stride = 0;
    };
    /// A question beside the last place, metres along the ray from it, before the value ahead is taken.
    struct Turn {
        bool active = false, tried = false;
        float along = 0, ahead = 0;
    };
    /// What is looked for: radians; metres; the clearance at which nothing more counts; whether it must be known well.
    struct Look {
        float radius, pixel, into, dark;
        bool sharp;
    };
    /// The radius about the last place that holds no surface, the stride from there, and how the field grew towards it.
    struct Pace {
        float free = 0, stride = 0, slope = -1;
    };
    WalkLine line_;
    Look look_;
    float start_, t_, end_, clearance_ = 1, within_ = 0;
    float freeUntil_ = -1;  // −1 while all of it is
    bool soft_;
    int steps_ = 0;
    Pace pace_;
    Passed passed_;
    Turn turn_;
    Doubts doubts_;
    Cell cell_;
};

/// Share of a disc that is free, by how far a straight edge is from its middle: −1 … 1 of its radius.
float shareOfDisc(float clearance);
/// Share of a part that counts as free, all or nothing but for a smooth step: 0 … 1 of its radius.
float shareOfPart(float clearance);
/// Towards the parts beside the middle of a disc of half angle `radius`, radians, about the unit vector `middle`.
std::array<Vec3f, DiscWalk::parts> directionsOfParts(Vec3f middle, float radius);

}  // namespace sgm::render

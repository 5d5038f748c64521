// Steps of a ray through cells, one evaluation of the field at a time: `ask` goes on to the next place where the field
// must be evaluated, `answer` takes its value there. So many rays walk together, and the field is evaluated for all of
// them at once. Enters: a prepared field, rays. Leaves: where they hit, or how much of a disc of light they see. The
// same steps as trace.comp.glsl and surface.comp.glsl take, which say where they come from.
#pragma once

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
    bool isRunning() const { return running_; }
    bool found() const { return found_; }
    /// Unit direction in which the field grew at the place, once it isn't found.
    Vec3f away() const { return away_; }

private:
    static constexpr int alongRay = -1, atFoot = 3, rounds = 3;
    void findFoot();

    Vec3f place_, foot_, slope_, away_;
    float value_ = 0, into_ = 0;
    int step_ = 0, round_ = 0;
    bool running_ = false, found_ = false;
    Cell cell_;
};

/// How far a place is from solid, as far as that matters, where the field's own value is in doubt.
class ClearanceWalk {
public:
    /// `value`: of the field at `place`, times the space's side; `enough`: more doesn't matter. Metres.
    ClearanceWalk(const CellSpace& space, Vec3f place, float value, float enough, float pixel);
    bool ask(const CellSpace& space, Question& question);
    void answer(const CellSpace& space, float value);
    float clearance() const { return value_; }

private:
    Vec3f place_;
    float value_, enough_;
    bool aside_ = false, ended_ = false;
    SolidProbe probe_;
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

/// Share that a place sees of a disc of light.
class DiscWalk {
public:
    /// `radius`: half the disc's angle, radians; `pixel`: of the picture at the place, metres.
    DiscWalk(const CellSpace& space, Vec3f place, Vec3f direction, float radius, float pixel);
    bool ask(const CellSpace& space, Question& question);
    void answer(const CellSpace& space, float value);
    /// 0 … 1.
    float seen() const;

private:
    /// Takes what the probe behind a small value found; false where the way must be walked again, every value probed.
    bool settleDoubt();
    /// A disc this small a share of which is free, by a value that may say nothing.
    void doubt(Vec3f place, float value, float clearance);

    /// Values that may say nothing of a surface.
    struct Doubts {
        bool careful = false, any = false, probing = false;
        Vec3f leastPlace;
        float leastValue = 0, probedClearance = 1;
        SolidProbe probe;
    };
    WalkLine line_;
    float start_, t_, end_, radius_, pixel_, into_, clearance_ = 1, within_ = 0, free_ = 0, stride_ = 0;
    int steps_ = 0;
    Doubts doubts_;
    Cell cell_;
};

}  // namespace sgm::render

// OpenSCAD (.scad): the solid tree as a program, a module a boolean. Round solids have as many sides as the option
// says.
#include <fmt/format.h>

#include <iterator>

#include "modeler/export/formats.h"
#include "modeler/export/out_file.h"
#include "modeler/export/surface.h"
#include "modeler/field/solid_tree.h"

namespace sgm::exporter {
namespace {

/// Unit solids between -1/2 and 1/2, y up, as the primitives lie in their scopes.
constexpr const char* unitSolids = R"(
module unit_cube() { cube(1, center = true); }
module unit_ellipsoid() { sphere(d = 1, $fn = sides); }
module unit_cylinder() { rotate([-90, 0, 0]) cylinder(h = 1, d = 1, center = true, $fn = sides); }
module unit_cone() { rotate([-90, 0, 0]) cylinder(h = 1, d1 = 1, d2 = 0, center = true, $fn = sides); }
module unit_pyramid() {
  polyhedron([[-.5, -.5, -.5], [.5, -.5, -.5], [.5, -.5, .5], [-.5, -.5, .5], [0, .5, 0]],
             [[3, 2, 1, 0], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]);
}
module unit_prism() { linear_extrude(height = 1, center = true) polygon([[-.5, -.5], [.5, -.5], [0, .5]]); }
module unit_wedge() { linear_extrude(height = 1, center = true) polygon([[-.5, -.5], [.5, -.5], [-.5, .5]]); }
module unit_torus(tube) {
  scale([1, .5 / tube, 1]) rotate([-90, 0, 0])
    rotate_extrude($fn = sides) translate([(1 - tube) / 2, 0]) circle(r = tube / 2, $fn = sides);
}
module capsule(x, y, z) {
  r = min(x, y, z) / 2;
  scale([x / 2 / r, 1, z / 2 / r]) hull() for (end = [-1, 1]) translate([0, end * (y / 2 - r), 0]) sphere(r, $fn = sides);
}
)";

std::string vectorOf(Vec3d v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }

/// "multmatrix(…) " of columns and a centre.
std::string placed(const Mat3& m, Vec3d c) {
    return fmt::format("multmatrix([[{}, {}, {}, {}], [{}, {}, {}, {}], [{}, {}, {}, {}]]) ", m.x.x, m.y.x, m.z.x, c.x,
                       m.x.y, m.y.y, m.z.y, c.y, m.x.z, m.y.z, m.z.z, c.z);
}

std::string solidText(const field::PlacedSolid& s, const Box3d& bounds) {
    const std::string_view name = s.primitive->name;
    if (name == "halfspace") {
        // As much of it as lies about the model: a box below the plane.
        const double reach = 2 * length(bounds.size()) + 2 * length(bounds.centre() - s.frame.centre);
        const Vec3d size{2 * reach, reach, 2 * reach};
        return placed(s.frame.rotation, s.frame.centre - s.frame.rotation.y * (reach / 2)) + "scale(" + vectorOf(size) +
               ") unit_cube();";
    }
    const std::string place = placed(s.frame.rotation, s.frame.centre);
    if (name == "capsule") return place + fmt::format("capsule({}, {}, {});", s.size.x, s.size.y, s.size.z);
    const std::string argument = s.arguments.empty() ? "" : fmt::format("{}", s.arguments[0]);
    return place + "scale(" + vectorOf(s.size) + ") unit_" + std::string(name == "sphere" ? "ellipsoid" : name) + "(" +
           argument + ");";
}

/// The solid with its colour, and where it is from as a comment.
std::string leafText(const field::PlacedSolid& s, const field::SolidTree& tree, const Provenance& provenance) {
    const Part& part = provenance.parts[s.origin];
    const Rgb8 c = srgb(provenance.materials[part.material].color);  // OpenSCAD shows colours as they are written
    return fmt::format("color([{:.3f}, {:.3f}, {:.3f}]) {}  // {}:{} {}", c[0] / 255.0, c[1] / 255.0, c[2] / 255.0,
                       solidText(s, tree.bounds), oneLine(part.file()), part.line(), oneLine(part.path.text()));
}

}  // namespace

static Status writeScad(const ExportInput& input, const Path& temporary, const Path& target) {
    using Op = field::SolidNode::Op;
    const field::SolidTree& tree = *input.solids;
    if (input.progress) input.progress->begin("write", tree.nodes.size());
    OutFile out(temporary, target, input.progress);
    out.text(fmt::format("// {}, written by sgm.\nsides = {};\n{}\n", oneLine(input.name),
                         option(input, "sides", "128"), unitSolids));
    for (size_t n = 0; n < tree.nodes.size() && !out.failed(); ++n, tick(input.progress)) {
        const field::SolidNode& node = tree.nodes[n];
        if (node.op == Op::Solid) {
            out.text(fmt::format("module n{}() {}\n", n, leafText(tree.solids[node.solid], tree, *input.provenance)));
            continue;
        }
        const char* op = node.op == Op::Union ? "union" : node.op == Op::Difference ? "difference" : "intersection";
        out.text(fmt::format("module n{}() {}() {{", n, op));
        for (const uint32_t o : node.operands) out.text(fmt::format(" n{}();", o));
        out.text(" }\n");
    }
    const Placement place = placementOf(input);
    out.text(fmt::format("\nscale({}) {}n{}();\n", place.unitsPerMetre, place.zUp ? "rotate([90, 0, 0]) " : "",
                         tree.nodes.size() - 1));
    return out.finish();
}

static constexpr ExportOption scadOptions[] = {
    upOption, unitOption, {"sides", "128", "16|32|64|128|256|512|1024|2048|4096", "sides of round solids, inscribed"}};

constinit const Exporter scadFormat{
    .extension = ".scad",
    .doc = "The solid tree as an OpenSCAD program: a module a boolean, of the same models",
    .options = scadOptions,
    .takesPositionsOnly = saysPositionsOnly,
    .write = writeScad,
    .stream = nullptr,
    .wantsSolids = true,
};

}  // namespace sgm::exporter

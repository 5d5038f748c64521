#include "modeler/town/town_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sgm::town {
namespace {

using plan::Vec2;

struct Layer {
    std::string_view name, fill, stroke;
};
/// From below to above.
constexpr Layer layers[] = {
    {"water", "#a9cde8", "none"},     {"park", "#b9dba0", "none"},    {"block", "#efeae0", "#b9b2a4"},
    {"inner", "#dfe8d2", "#8a8578"},  {"lot", "#e3dccb", "#8a8578"},  {"corner", "#e8d3b8", "#8a8578"},
    {"street", "#ffffff", "none"},    {"highway", "#f5c56b", "none"}, {"crossing", "#ffffff", "none"},
    {"bridge", "#c9c4bb", "#6d6a64"},
};

/// Millimetres are enough, and print the same on every machine.
std::string number(double v) {
    const double mm = std::round(v * 1000);
    std::string text = fmt::format("{:.3f}", (mm == 0 ? 0.0 : mm) / 1000);
    while (text.back() == '0') text.pop_back();
    if (text.back() == '.') text.pop_back();
    return text;
}

void appendPath(std::string& out, const plan::Ring& ring) {
    for (size_t i = 0; i < ring.size(); ++i)
        out += fmt::format("{}{} {}", i == 0 ? "M" : " L", number(ring.points[i].x), number(ring.points[i].z));
    out += " Z";
}

void appendCoordinates(std::string& out, const plan::Ring& ring) {
    // North is up there: the mirrored ring is turned round, so that outlines stay counter-clockwise.
    out += '[';
    for (size_t i = 0; i <= ring.size(); ++i) {
        const Vec2 p = ring.points[(2 * ring.size() - i) % ring.size()];
        out += fmt::format("{}[{},{}]", i == 0 ? "" : ",", number(p.x), number(p.z == 0 ? 0 : -p.z));
    }
    out += ']';
}

}  // namespace

void writeSvg(const TownPlan& plan, const TextSink& write) {
    plan::Box2 box;
    for (const PlanFeature& f : plan.features) {
        const plan::Box2 own = bounds(f.area);
        if (!own.empty()) box.add(own.lo), box.add(own.hi);
    }
    if (box.empty()) box.add({0, 0});
    const Vec2 size = box.size();
    write(fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{} {} {} {}\">\n", number(box.lo.x),
                      number(box.lo.z), number(size.x), number(size.z)));
    for (const Layer& layer : layers) {
        bool any = false;
        for (const PlanFeature& f : plan.features) {
            if (f.layer != layer.name) continue;
            if (!any)
                write(fmt::format(
                    "<g class=\"{}\" fill=\"{}\" stroke=\"{}\" stroke-width=\".3\" fill-rule=\"evenodd\">\n",
                    layer.name, layer.fill, layer.stroke));
            any = true;
            std::string out = "<path d=\"";
            for (const plan::Polygon& polygon : f.area.polygons) {
                appendPath(out, polygon.outer);
                for (const plan::Ring& court : polygon.courts) appendPath(out, court);
            }
            write(out + (f.key ? fmt::format("\" id=\"{}-{:016x}\"/>\n", layer.name, f.key) : "\"/>\n"));
        }
        if (any) write("</g>\n");
    }
    write("</svg>\n");
}

void writeGeoJson(const TownPlan& plan, const TextSink& write) {
    // Without a name a small town's metres would be read as degrees.
    write(
        "{\"type\":\"FeatureCollection\",\"crs\":{\"type\":\"name\",\"properties\":{\"name\":\"urn:sgm:crs:metres\"}},"
        "\"features\":[\n");
    bool first = true;
    for (const PlanFeature& f : plan.features) {
        if (f.area.polygons.empty()) continue;
        std::string out = first ? "" : ",\n";
        first = false;
        out += fmt::format("{{\"type\":\"Feature\",\"properties\":{{\"layer\":\"{}\",\"area\":{}", f.layer,
                           number(area(f.area)));
        if (f.key) out += fmt::format(",\"key\":\"{:016x}\"", f.key);
        if (f.street_m > 0) out += fmt::format(",\"street\":{}", number(f.street_m));
        out += "},\"geometry\":{\"type\":\"MultiPolygon\",\"coordinates\":[";
        for (size_t i = 0; i < f.area.polygons.size(); ++i) {
            out += i ? ",[" : "[";
            appendCoordinates(out, f.area.polygons[i].outer);
            for (const plan::Ring& court : f.area.polygons[i].courts) out += ',', appendCoordinates(out, court);
            out += ']';
        }
        write(out + "]}}");
    }
    write("\n]}\n");
}

}  // namespace sgm::town

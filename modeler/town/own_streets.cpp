#include "modeler/town/own_streets.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "modeler/core/printable.h"
#include "modeler/core/regular_file.h"

namespace sgm::town {
namespace {

constexpr double weld_m = 1;         // ends and crossings nearer to one another are one node
constexpr double widest_m = 4e5;     // of streets in degrees: what is wider was given in metres
constexpr double waterSample_m = 5;  // between places where the water map is read along a street

/// The words of OpenStreetMap for roads between quarters, and for ways that are none for cars.
constexpr std::array<std::string_view, 10> highwayWords{"motorway", "motorway_link", "trunk",     "trunk_link",
                                                        "primary",  "primary_link",  "secondary", "secondary_link",
                                                        "highway",  "expressway"};
constexpr std::array<std::string_view, 11> walkWords{"footway",   "path",         "steps",   "cycleway",
                                                     "bridleway", "corridor",     "track",   "pedestrian",
                                                     "proposed",  "construction", "platform"};

template <class Words>
bool isOne(const Words& words, std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

/// What a feature's properties make of its lines; nothing for ways that aren't streets.
Result<std::optional<OwnStreet>> kindOf(const plan::LineFeature& feature) {
    OwnStreet street;
    const auto text = [&](std::string_view name) -> const std::string* {
        for (const plan::Property& p : feature.properties)
            if (p.name == name) return std::get_if<std::string>(&p.value);
        return nullptr;
    };
    for (const plan::Property& p : feature.properties) {
        if (p.name == "class") {
            const auto* word = std::get_if<std::string>(&p.value);
            if (!word || (*word != "highway" && *word != "street"))
                return Error{
                    Error::Kind::Input,
                    fmt::format("feature {}: its class is {}: write \"highway\" or \"street\", or leave it out",
                                feature.place, word ? "\"" + printable(*word) + "\"" : std::string("no text"))};
            street.kind = *word == "highway" ? RoadClass::Highway : RoadClass::Street;
        }
        if (p.name == "bridge") {
            const auto* word = std::get_if<std::string>(&p.value);
            const auto* number = std::get_if<double>(&p.value);
            street.bridge = word ? *word != "no" && *word != "false" && !word->empty() : number && *number != 0;
        }
    }
    if (const auto* word = text("highway"); word && !text("class")) {
        if (isOne(walkWords, *word)) return std::optional<OwnStreet>{};
        street.kind = isOne(highwayWords, *word) ? RoadClass::Highway : RoadClass::Street;
    }
    return std::optional(street);
}

/// The part of a–b inside a rectangle (Liang & Barsky 1984), as shares of its length.
std::optional<std::pair<double, double>> insideShare(Vec2 a, Vec2 b, Vec2 lo, Vec2 hi) {
    double from = 0, to = 1;
    const Vec2 d = b - a;
    const auto clip = [&](double p, double q) {
        if (p == 0) return q >= 0;
        const double t = q / p;
        if (p < 0)
            from = std::max(from, t);
        else
            to = std::min(to, t);
        return from < to;
    };
    if (!clip(-d.x, a.x - lo.x) || !clip(d.x, hi.x - a.x) || !clip(-d.z, a.z - lo.z) || !clip(d.z, hi.z - a.z))
        return std::nullopt;
    return std::pair(from, to);
}

class Layer {
public:
    Layer(RoadGraph& graph, const RoadParameters& parameters, const Land& land, OwnStreetsReport& report)
        : graph_(graph), parameters_(parameters), land_(land), report_(report) {}

    void lay(const OwnStreet& street) {
        kind_ = street.kind, bridge_ = street.bridge;
        const double apart_m = parameters_.block_m;
        double since = apart_m;
        uint32_t last = noIndex;
        for (size_t i = 0; i + 1 < street.line.size(); ++i) {
            const Vec2 a = street.line[i], b = street.line[i + 1];
            const auto inside = insideShare(a, b, parameters_.lo, parameters_.hi);
            const double length_m = lengthOf(b - a);
            if (!inside || !(length_m > 0)) {
                last = noIndex;
                continue;
            }
            if (inside->first > 0) last = noIndex, since = apart_m;
            if (last == noIndex) last = nodeAt(pointAt(a + (b - a) * inside->first));
            const Vec2 from = graph_.metresAt(last), to = a + (b - a) * inside->second;
            const double rest = lengthOf(to - from);
            const Vec2 way = unit(to - from);
            if (since >= apart_m) stop(last, way), since = 0;
            // Places a block apart along the line, so that streets may branch there.
            double done = 0;
            for (double at = apart_m - since; at < rest - weld_m; at += apart_m) {
                last = run(last, pointAt(from + way * at));
                stop(last, way);
                done = at, since = 0;
            }
            last = run(last, pointAt(to));
            since += rest - done;
            if (i + 2 == street.line.size() || inside->second < 1) stop(last, way);
            if (inside->second < 1) last = noIndex;
        }
    }

    std::vector<OwnStop> stops;

private:
    void stop(uint32_t node, Vec2 heading) { stops.push_back({node, heading, kind_}); }

    /// The node there or nearest within weld_m, else a new one; one that lies in an edge divides it.
    uint32_t nodeAt(Point at) {
        if (const uint32_t found = nodeNear(at); found != noIndex) return found;
        for (const uint32_t e : graph_.edgesNear(at, at, weld_m)) {
            const Vec2 a = graph_.metresAt(graph_.edge(e).a), d = graph_.metresAt(graph_.edge(e).b) - a;
            const double t = std::clamp(dot(metres(at) - a, d) / dot(d, d), 0.0, 1.0);
            if (lengthOf(a + d * t - metres(at)) >= weld_m) continue;
            if (const uint32_t node = divide(e, pointAt(a + d * t)); node != noIndex) return node;
        }
        return graph_.addNode(at);
    }

    uint32_t nodeNear(Point at) const {
        uint32_t found = noIndex;
        double least = weld_m;
        for (const uint32_t n : graph_.nodesNear(at, at, weld_m))
            if (const double away = lengthOf(graph_.metresAt(n) - metres(at)); away < least) least = away, found = n;
        return found;
    }

    /// A node in the edge at the lattice point next to it, or noIndex where a half would touch something.
    uint32_t divide(uint32_t edge, Point at) {
        const RoadEdge e = graph_.edge(edge);
        const Point p = graph_.at(e.a), q = graph_.at(e.b);
        if (at == p) return e.a;
        if (at == q) return e.b;
        if (!graph_.isFree(p, at, e.a, noIndex, edge) || !graph_.isFree(at, q, noIndex, e.b, edge)) return noIndex;
        return graph_.splitEdge(edge, at);
    }

    /// The first edge between `from` and `to` that doesn't end at `from`, and where.
    std::optional<std::pair<uint32_t, Point>> firstCrossing(uint32_t from, Point to) const {
        const Point a = graph_.at(from);
        const Vec2 begin = metres(a), d = metres(to) - begin;
        std::optional<std::pair<uint32_t, Point>> first;
        double least = 2;
        for (const uint32_t index : graph_.edgesNear(a, to, 0)) {
            const RoadEdge& e = graph_.edge(index);
            if (e.a == from || e.b == from) continue;
            const Point p = graph_.at(e.a), q = graph_.at(e.b);
            if (!segmentsMeet(a, to, p, q)) continue;
            const Vec2 along = metres(q) - metres(p);
            const double by = cross(d, along);
            // Of an edge that lies on the same line, its nearer end.
            const double t =
                by != 0
                    ? std::clamp(cross(metres(p) - begin, along) / by, 0.0, 1.0)
                    : std::clamp(std::min(dot(metres(p) - begin, d), dot(metres(q) - begin, d)) / dot(d, d), 0.0, 1.0);
            if (t >= least) continue;
            least = t;
            first = std::pair(index, pointAt(begin + d * t));
        }
        return first;
    }

    /// Lays from a node to a place, through all that lies between; returns the node there.
    uint32_t run(uint32_t node, Point to) {
        const uint32_t end = nodeAt(to);
        std::vector<uint32_t> passed;
        while (node != end) {
            passed.push_back(node);
            const auto crossing = firstCrossing(node, graph_.at(end));
            uint32_t next = end;
            if (crossing) {
                next = nodeNear(crossing->second);
                if (next == noIndex || next == node) next = divide(crossing->first, crossing->second);
            }
            // Nodes beside the line draw it to them: no way leads back.
            if (next == noIndex || std::find(passed.begin(), passed.end(), next) != passed.end())
                return ++report_.refused, end;
            connect(node, next);
            node = next;
        }
        return end;
    }

    void connect(uint32_t a, uint32_t b) {
        if (graph_.areJoined(a, b)) return;  // the same street again
        if (!graph_.isFree(graph_.at(a), graph_.at(b), a, b)) {
            ++report_.refused;
            return;
        }
        graph_.addEdge(a, b, kind_, bridge_ || isWet(graph_.metresAt(a), graph_.metresAt(b)), true);
    }

    bool isWet(Vec2 a, Vec2 b) const {
        if (!land_.water) return false;
        const int count = std::max(1, static_cast<int>(std::ceil(lengthOf(b - a) / waterSample_m)));
        for (int i = 0; i <= count; ++i)
            if (land_.water(a + (b - a) * (static_cast<double>(i) / count))) return true;
        return false;
    }

    RoadGraph& graph_;
    const RoadParameters& parameters_;
    const Land& land_;
    OwnStreetsReport& report_;
    RoadClass kind_ = RoadClass::Street;
    bool bridge_ = false;
};

}  // namespace

Result<OwnStreets> readStreetsBytes(std::string_view bytes, const plan::ReadLimits& limits, const Progress* progress) {
    auto read = plan::readGeoJsonLines(bytes, limits, progress);
    if (!read.ok()) return read.error();
    OwnStreets out;
    out.fromDegrees = read->fromDegrees;
    for (plan::LineFeature& feature : read->list) {
        auto kind = kindOf(feature);
        if (!kind.ok()) return kind.error();
        if (!*kind) continue;
        for (auto& line : feature.lines) {
            OwnStreet& street = out.list.emplace_back(**kind);
            street.line = std::move(line);
            for (const Vec2 p : street.line) out.box.add(p);
        }
    }
    const Vec2 extent = out.box.empty() ? Vec2{} : out.box.size();
    if (out.fromDegrees && std::max(extent.x, extent.z) > widest_m)
        return Error{Error::Kind::Input,
                     fmt::format("its coordinates are within 180 and 90 and were read as longitude and latitude, which "
                                 "makes {:.0f} x {:.0f} km: where they are metres, name a plane in its \"crs\", as "
                                 "\"urn:ogc:def:crs:EPSG::25832\"",
                                 extent.x / 1000, extent.z / 1000)};
    if (out.list.empty()) return Error{Error::Kind::Input, "its lines are all ways for walkers; streets are needed"};
    return out;
}

Result<OwnStreets> readStreets(const std::filesystem::path& path, const Progress* progress) {
    const plan::ReadLimits limits;
    const auto named = [&](const Error& e) {
        return e.kind == Error::Kind::Cancelled
                   ? e
                   : Error{e.kind, fmt::format("{}: {}", printable(path.string()), e.message)};
    };
    const auto bytes = readRegularFile(path, limits.mostBytes, progress);
    if (!bytes) return named(bytes.error());
    auto streets = readStreetsBytes(*bytes, limits, progress);
    if (!streets.ok()) return named(streets.error());
    streets->name = path.filename().string();
    return streets;
}

std::vector<OwnStop> layStreets(RoadGraph& graph, const OwnStreets& streets, const RoadParameters& parameters,
                                const Land& land, OwnStreetsReport& report) {
    Layer layer(graph, parameters, land, report);
    for (const OwnStreet& street : streets.list) layer.lay(street);
    for (const RoadEdge& e : graph.edges()) report.laid += !e.removed && e.own;
    if (report.laid == 0) return {};
    std::erase_if(layer.stops, [&](const OwnStop& s) { return graph.degree(s.node) == 0; });
    return std::move(layer.stops);
}

size_t keepLargestComponent(RoadGraph& graph) {
    std::vector<uint32_t> root(graph.nodes().size()), size(graph.nodes().size(), 0);
    std::iota(root.begin(), root.end(), 0u);
    const auto find = [&](uint32_t n) {
        while (root[n] != n) n = root[n] = root[root[n]];
        return n;
    };
    for (const RoadEdge& e : graph.edges())
        if (!e.removed) root[std::max(find(e.a), find(e.b))] = std::min(find(e.a), find(e.b));
    for (const RoadEdge& e : graph.edges())
        if (!e.removed) ++size[find(e.a)];
    if (size.empty()) return 0;
    const auto largest = static_cast<uint32_t>(std::max_element(size.begin(), size.end()) - size.begin());
    size_t gone = 0;
    for (uint32_t e = 0; e < graph.edges().size(); ++e) {
        const RoadEdge edge = graph.edge(e);
        if (edge.removed || find(edge.a) == largest) continue;
        gone += edge.own;
        graph.remove(e);
    }
    return gone;
}

}  // namespace sgm::town

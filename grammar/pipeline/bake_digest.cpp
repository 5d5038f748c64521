#include "grammar/pipeline/bake_digest.h"

#include <fmt/format.h>

#include <string_view>
#include <variant>
#include <vector>

#include "modeler/town/own_streets.h"

namespace sgm::pipeline {
namespace {

/// Facts one after the other, of which none can pass into the next one.
class Facts {
public:
    void add(std::string_view text) { text_ += fmt::format("{}:{}", text.size(), text); }
    void add(double number) { text_ += fmt::format("{:a} ", number); }
    template <class T>
    void add(const std::vector<T>& list) {
        static_assert(std::has_unique_object_representations_v<T> || std::is_same_v<T, float>);
        add(tiles::digestOf({reinterpret_cast<const char*>(list.data()), list.size() * sizeof(T)}));
    }
    std::string digest() const { return tiles::digestOf(text_); }

private:
    std::string text_;
};

void add(Facts& facts, plan::Vec2 point) {
    facts.add(point.x);
    facts.add(point.z);
}

void add(Facts& facts, const plan::Ring& ring) {
    facts.add(double(ring.size()));
    for (const plan::Vec2 point : ring.points) add(facts, point);
    for (const plan::Edge& edge : ring.edges) facts.add(edge.tag);
}

void add(Facts& facts, const plan::Feature& feature) {
    facts.add(feature.name);
    for (const std::string& tag : feature.footprint.tags) facts.add(tag);
    for (const plan::Polygon& polygon : feature.footprint.polygons) {
        add(facts, polygon.outer);
        for (const plan::Ring& court : polygon.courts) add(facts, court);
    }
    for (const plan::Property& property : feature.properties) {
        facts.add(property.name);
        std::visit([&](const auto& value) { facts.add(value); }, property.value);
    }
}

void add(Facts& facts, const town::Raster& raster) {
    facts.add(raster.width);
    facts.add(raster.grey);
    facts.add(raster.color);
    facts.add(raster.numbers);
    if (raster.extent_m) add(facts, *raster.extent_m);
}

void add(Facts& facts, const town::OwnStreets& streets) {
    for (const town::OwnStreet& street : streets.list) {
        facts.add(fmt::format("{} {} {}", static_cast<int>(street.kind), street.bridge, street.line.size()));
        for (const plan::Vec2 point : street.line) add(facts, point);
    }
}

/// What a grammar was read from. Features by their own digests, so that a city's outlines needn't stand in one text.
void add(Facts& facts, const rules::Grammar& grammar) {
    for (const syntax::SourcePtr& source : grammar.sources) facts.add(source->text());
    for (const image::ImageFilePtr& picture : grammar.images)
        if (picture) facts.add(tiles::digestOf(picture->bytes));
    for (const field::SampledGridPtr& mesh : grammar.meshes)
        if (mesh) facts.add(mesh->words());
    for (const auto& outlines : grammar.outlines)
        if (outlines)
            for (const plan::Feature& feature : outlines->list) {
                Facts own;
                add(own, feature);
                facts.add(own.digest());
            }
    for (const rules::Map& map : grammar.maps)
        if (map.picture.raster) add(facts, *map.picture.raster);
    for (const rules::Roads& roads : grammar.roads)
        if (roads.streets) add(facts, *roads.streets);
}

}  // namespace

std::string digestOf(const derive::Derivation& derivation, const BakeRequest& request) {
    Facts facts;
    add(facts, *derivation.grammar);
    for (const rules::Value& value : derivation.params) facts.add(rules::toText(value));
    facts.add(derivation.way);
    facts.add(fmt::format("{} {} {:a} {:a} {:a} {} {}", derivation.start, derivation.seed, request.side_m,
                          request.cell_m, request.objectCell_m, request.levels, static_cast<int>(request.packing)));
    return facts.digest();
}

}  // namespace sgm::pipeline

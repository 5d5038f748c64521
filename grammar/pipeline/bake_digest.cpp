#include "grammar/pipeline/bake_digest.h"

#include <fmt/format.h>

#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "modeler/town/own_streets.h"

namespace sgm::pipeline {
namespace {

/// What a digest is of: texts with their lengths and numbers, so that different lists of them are different bytes.
class DigestInput {
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

void add(DigestInput& input, plan::Vec2 point) {
    input.add(point.x);
    input.add(point.z);
}

void add(DigestInput& input, const plan::Ring& ring) {
    input.add(double(ring.size()));
    for (const plan::Vec2 point : ring.points) add(input, point);
    for (const plan::Edge& edge : ring.edges) input.add(edge.tag);
}

void add(DigestInput& input, const plan::Feature& feature) {
    input.add(feature.name);
    for (const std::string& tag : feature.footprint.tags) input.add(tag);
    for (const plan::Polygon& polygon : feature.footprint.polygons) {
        add(input, polygon.outer);
        for (const plan::Ring& court : polygon.courts) add(input, court);
    }
    for (const plan::Property& property : feature.properties) {
        input.add(property.name);
        std::visit([&](const auto& value) { input.add(value); }, property.value);
    }
}

void add(DigestInput& input, const town::Raster& raster) {
    input.add(raster.width);
    input.add(raster.grey);
    input.add(raster.color);
    input.add(raster.numbers);
    if (raster.extent_m) add(input, *raster.extent_m);
}

void add(DigestInput& input, const town::OwnStreets& streets) {
    for (const town::OwnStreet& street : streets.list) {
        input.add(fmt::format("{} {} {}", static_cast<int>(street.kind), street.bridge, street.line.size()));
        for (const plan::Vec2 point : street.line) add(input, point);
    }
}

/// What a grammar was read from. Features by their own digests, so that a city's outlines needn't stand in one text.
void add(DigestInput& input, const rules::Grammar& grammar) {
    for (const syntax::SourcePtr& source : grammar.sources) input.add(source->text());
    for (const image::ImageFilePtr& picture : grammar.images)
        if (picture) input.add(tiles::digestOf(picture->bytes));
    for (const field::SampledGridPtr& mesh : grammar.meshes)
        if (mesh) input.add(mesh->words());
    for (const auto& outlines : grammar.outlines)
        if (outlines)
            for (const plan::Feature& feature : outlines->list) {
                DigestInput own;
                add(own, feature);
                input.add(own.digest());
            }
    for (const rules::Map& map : grammar.maps)
        if (map.picture.raster) add(input, *map.picture.raster);
    for (const rules::Roads& roads : grammar.roads)
        if (roads.streets) add(input, *roads.streets);
}

}  // namespace

std::string digestOf(const derive::Derivation& derivation, const BakeRequest& request) {
    DigestInput input;
    add(input, *derivation.grammar);
    for (const rules::Value& value : derivation.params) input.add(rules::toText(value));
    input.add(derivation.way);
    input.add(fmt::format("{} {} {:a} {:a} {:a} {} {}", derivation.start, derivation.seed, request.side_m,
                          request.cell_m, request.objectCell_m, request.levels, static_cast<int>(request.packing)));
    return input.digest();
}

}  // namespace sgm::pipeline

#include "grammar/derive/map_layer.h"

#include <algorithm>

#include "grammar/derive/builder.h"
#include "grammar/derive/expressions.h"

namespace sgm::derive {

Result<MapLayer> mapLayer(const Derivation& derivation, uint32_t map, const plan::Box2& area, uint32_t columns,
                          uint32_t rows) {
    Derivation asked;
    asked.grammar = derivation.grammar;
    asked.params = derivation.params;
    asked.seed = derivation.seed;
    TreeBuilder builder(asked, {}, nullptr);
    MapLayer layer{derivation.grammar->maps[map].name, area, columns, rows, {}, {}, 0, 0};
    rules::Expr ask;
    ask.kind = rules::Expr::Kind::Map;
    ask.index = map;
    Place place;
    place.tree = &asked.tree;
    place.params = asked.params;
    place.builder = &builder;
    for (uint32_t row = 0; row < rows; ++row)
        for (uint32_t column = 0; column < columns; ++column) {
            place.scope.centre = {area.lo.x + area.size().x * (column + .5) / columns, 0,
                                  area.lo.z + area.size().z * (row + .5) / rows};
            const rules::Value value = evaluate(ask, place);
            if (builder.monitor().failed()) return builder.monitor().takeFailure();
            if (value.kind != rules::Value::Kind::Word) {
                layer.values.push_back(static_cast<float>(value.num()));
                continue;
            }
            const auto known = std::find(layer.words.begin(), layer.words.end(), value.text);
            layer.values.push_back(static_cast<float>(known - layer.words.begin()));
            if (known == layer.words.end()) layer.words.push_back(value.text);
        }
    const auto [least, most] = std::minmax_element(layer.values.begin(), layer.values.end());
    if (!layer.values.empty()) layer.least = *least, layer.most = *most;
    return layer;
}

}  // namespace sgm::derive

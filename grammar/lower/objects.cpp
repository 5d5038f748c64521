#include "grammar/lower/objects.h"

#include <fmt/format.h>

#include <algorithm>

#include "grammar/derive/lift.h"
#include "grammar/lower/likeness.h"
#include "modeler/core/distinct_names.h"
#include "modeler/field/primitives.h"

namespace sgm::lower {
namespace {

using derive::none;
using derive::Shape;
using derive::ShapeId;

ObjectValue valueOf(const rules::Value& value) {
    const bool plain = value.units[0] == rules::Unit::None || value.units[0] == rules::Unit::Metre;
    if (value.kind == rules::Value::Kind::Number && plain) return value.num();
    if (value.kind == rules::Value::Kind::Vector && value.count == 3) return Vec3d{value.n[0], value.n[1], value.n[2]};
    return value.kind == rules::Value::Kind::Text ? value.text : rules::toText(value);
}

/// Which shapes of a derivation are objects, and the tree of them.
class Divider {
public:
    Divider(const derive::Derivation& d, const Model& model)
        : d_(d), tree_(d.tree), model_(model), likenesses_(likenesses(d, model)) {
        isObject_.resize(tree_.shapes.size());
    }

    /// Every shape that owns surface.
    void takeOwners() {
        for (const ShapeId s : model_.shapeOf)
            if (s != none) isObject_[s] = true;
    }

    /// Every shape of that symbol or label; Error::Usage where nothing bears the name.
    Status take(const std::string& symbol) {
        const auto& symbols = d_.grammar->symbols;
        bool known = std::any_of(symbols.begin(), symbols.end(), [&](const auto& s) { return s.name == symbol; });
        for (ShapeId s = 0; s < tree_.shapes.size(); ++s) {
            if (tree_.labels[tree_.shapes[s].label] != symbol && symbolOf(s) != symbol) continue;
            isObject_[s] = known = true;
        }
        if (known) return Done{};
        std::vector<std::string> names = tree_.labels;
        const std::string near = syntax::didYouMean(symbol, names);
        std::sort(names.begin(), names.end());
        names.erase(std::unique(names.begin(), names.end()), names.end());
        return Error{Error::Kind::Usage, fmt::format("no shape is called '{}'{}; there are {}", symbol,
                                                     near.empty() ? "" : fmt::format(" (did you mean '{}'?)", near),
                                                     fmt::join(names, ", "))};
    }

    ObjectTree tree() {
        isObject_[0] = true;
        std::vector<bool> kept = isObject_;  // and all above them
        for (ShapeId s = 0; s < tree_.shapes.size(); ++s)
            if (isObject_[s])
                for (ShapeId a = tree_.shapes[s].parent; a != none && !kept[a]; a = tree_.shapes[a].parent)
                    kept[a] = true;
        ObjectTree out;
        std::vector<uint32_t> node(tree_.shapes.size(), 0), holder(tree_.shapes.size(), 0);
        for (ShapeId s = 0; s != none; s = tree_.next(s)) {
            const ShapeId parent = tree_.shapes[s].parent;
            node[s] = kept[s] ? static_cast<uint32_t>(out.nodes.size()) : node[parent];
            holder[s] = isObject_[s] ? node[s] : holder[parent];
            if (kept[s]) out.nodes.push_back(nodeOf(s, parent == none ? 0 : node[parent]));
        }
        for (const ShapeId s : model_.shapeOf) out.ofOrigin.push_back(s == none ? 0 : holder[s]);
        return out;
    }

private:
    std::string_view symbolOf(ShapeId id) const {
        const rules::SymbolId symbol = tree_.shapes[id].symbol;
        return symbol == rules::none ? std::string_view() : std::string_view(d_.grammar->symbols[symbol].name);
    }

    ObjectNode nodeOf(ShapeId id, uint32_t parent) {
        const Shape& s = tree_.shapes[id];
        ObjectNode node;
        node.name = names_.take(tree_.labels[s.label]);
        node.parent = parent;
        node.path = tree_.path(id);
        node.symbol = tree_.labels[s.label];
        if (s.madeBy != none) node.rule = d_.grammar->rules[d_.steps[s.madeBy].rule].name;
        if (s.span.source) {
            node.file = s.span.source->name();
            node.line = s.span.source->place(s.span.begin).line;
        }
        node.likeness = likenesses_[id];
        node.centre = derive::liftedScope(d_, id).centre;
        node.values.emplace_back("size", s.scope.size);
        addSolid(tree_.solidOf(id), node);
        if (const auto* extras = tree_.extrasOf(id))
            for (const auto& [name, value] : extras->values) node.values.emplace_back("with " + name, valueOf(value));
        return node;
    }

    /// What a shape's own solid is, with its arguments.
    static void addSolid(const derive::SolidValue* solid, ObjectNode& node) {
        if (!solid || !solid->primitive) return;
        node.values.emplace_back("solid", std::string(solid->primitive->name));
        for (size_t i = 0; i < solid->args.size(); ++i)
            node.values.emplace_back("solid " + std::string(solid->primitive->parameters[i].name),
                                     valueOf(solid->args[i]));
    }

    const derive::Derivation& d_;
    const derive::ShapeTree& tree_;
    const Model& model_;
    std::vector<uint64_t> likenesses_;  ///< by shape
    std::vector<bool> isObject_;        ///< by shape
    DistinctNames names_;
};

}  // namespace

Result<ObjectChoice> parseObjects(std::string_view text) {
    using By = ObjectChoice::By;
    if (text == "none") return ObjectChoice{By::None, {}};
    if (text == "material") return ObjectChoice{By::Material, {}};
    if (text == "shape") return ObjectChoice{By::Shape, {}};
    ObjectChoice choice{By::Symbol, {}};
    for (size_t begin = 0; begin <= text.size();) {
        const size_t end = std::min(text.find(',', begin), text.size());
        choice.symbols.emplace_back(text.substr(begin, end - begin));
        if (choice.symbols.back().empty())
            return Error{Error::Kind::Usage,
                         fmt::format("objects '{}': write none, material, shape, or symbols as Storey,Window", text)};
        begin = end + 1;
    }
    return choice;
}

Result<ObjectTree> objectTree(const derive::Derivation& derivation, const Model& model, const ObjectChoice& choice) {
    Divider divider(derivation, model);
    if (choice.by == ObjectChoice::By::Shape) divider.takeOwners();
    for (const std::string& symbol : choice.symbols)
        if (const Status s = divider.take(symbol); !s.ok()) return s.error();
    return divider.tree();
}

}  // namespace sgm::lower

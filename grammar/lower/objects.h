// Shape tree to the objects of a file.
// Enters: a Derivation, its Model and what the user calls an object. Leaves: an ObjectTree. Assumes that the model was
// lowered from that derivation.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "grammar/lower/lower.h"
#include "modeler/core/object_tree.h"

namespace sgm::lower {

/// What becomes an object of a file.
struct ObjectChoice {
    enum class By {
        None,      ///< nothing: the surface is one piece
        Material,  ///< nothing, but the surface is divided by material
        Symbol,    ///< every shape of one of `symbols`
        Shape      ///< every shape that owns surface
    };
    By by = By::Material;
    std::vector<std::string> symbols;  ///< of symbols, terminals or primitives

    /// Whether there are objects beside the whole.
    bool divides() const { return by == By::Symbol || by == By::Shape; }
    friend bool operator==(const ObjectChoice&, const ObjectChoice&) = default;
};

/// Reads "none", "material", "shape" or "SYMBOL,SYMBOL…". Error::Usage for a text without a name.
Result<ObjectChoice> parseObjects(std::string_view text);

/// The shapes that `choice` makes objects, with all shapes above them as groups. A triangle belongs to the nearest one
/// of them, its own shape or one above. The root is the whole model. Error::Usage for a symbol that neither the grammar
/// nor the tree has. O(shapes).
Result<ObjectTree> objectTree(const derive::Derivation& derivation, const Model& model, const ObjectChoice& choice);

}  // namespace sgm::lower

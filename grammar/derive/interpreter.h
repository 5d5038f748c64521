// Runs the bodies of rules: what an application of a rule adds to the tree.
// Enters: a rule and the shape it matched. Leaves: new shapes and bonds in the builder, steps in the log. Assumes checked
// rules. Recursion follows the nesting of the text, never the depth of the tree.
// Sources: rules.cpp matches and applies, bodies.cpp runs control, place.cpp puts shapes, content.cpp fills them, split.cpp cuts their scopes.
#pragma once

#include <array>
#include <map>
#include <unordered_map>

#include "grammar/derive/builder.h"
#include "grammar/derive/expressions.h"

namespace sgm::derive {

class Interpreter {
public:
    Interpreter(TreeBuilder& builder, std::span<const rules::Value> params);

    /// The root and the start's body.
    void start(const rules::Start& start, uint64_t seed);
    /// Applies the rule to a live shape, a `repeat` with its whole chain, and logs it.
    void apply(uint32_t rule, ShapeId shape, uint32_t generation);
    /// Guard apart: symbol, `beside`, chain, and a joint left for what the body grows.
    bool matches(uint32_t rule, ShapeId shape);
    /// Where expressions about a shape stand, drawing from its own stream.
    Place placeOf(ShapeId shape) const;
    /// True when a joint, a count or a neighbour decides whether the rule matches: it may match later.
    bool readsWorld(uint32_t rule) const { return facts_[rule].readsWorld; }

private:
    /// What is known of a rule before it runs.
    struct RuleFacts {
        uint64_t hash = 0;
        bool readsWorld = false;
    };
    /// What is known of an element before it runs: filled at its first use.
    struct ElementFacts {
        uint64_t hash = 0;
        uint32_t label = 0, jointSet = 0, solid = none, closed = none;
        bool constantSolid = false;
        uint64_t solidParams = 0;  ///< those that the constant solid reads, as Piece::params
        uint32_t solidTurn = 0;    ///< in which run it was made (Recording::turn)
        const rules::Attribute *at = nullptr, *to = nullptr, *on = nullptr, *size = nullptr, *turn = nullptr;
    };
    /// The shapes of a chain that `on` speaks of.
    struct Links {
        ShapeId root = none, last = none, newest = none;
        std::array<std::vector<ShapeId>, faceCount> toward, placed;
        bool ownSymbol = false;  ///< `newest` was found in this step and has the rule's own symbol
    };
    /// One run of a body: the shape it speaks of, and the node that its operators join.
    struct Frame {
        ShapeId matched = none, node = none;
        uint64_t key = 0;
        Place place;
        Links* links = nullptr;
        bool wholeContent = false;  ///< in `finally`: a newcomer without a joint fills the box of everything grown
    };
    /// What the operators of a sibling chain join: the node that holds them and the shape whose joints they name.
    struct Target {
        ShapeId node = none, host = none;
    };
    /// An element's attributes, evaluated.
    struct Looks {
        Scope scope;  ///< the newcomer's size and axes; its centre comes from the mating
        Vec3d moved_m;
        double overlap = 0, amount = 0.5, blend_m = 0;
        std::optional<Vec3f> color;
        const rules::Expr* colorBy = nullptr;  ///< what gave the colour
        std::optional<float> rough, metal;
        Extras extras;
    };
    using Elements = std::vector<rules::Element>;

    // bodies.cpp; `followed`: operators may come that join the shape placed here
    bool runBody(const rules::Body& body, const Frame& frame, uint64_t loop);
    bool runInner(const rules::Body& body, Frame& frame, Target& target, uint64_t loop, bool followed);
    bool runElements(const Elements& elements, Frame& frame, Target& target, uint64_t loop, bool followed);
    bool runElement(const rules::Element& e, Frame& frame, Target& target, uint64_t loop, bool followed);
    bool runFor(const rules::Element& e, Frame& frame, Target& target, uint64_t loop, bool followed);
    bool runWhile(const rules::Element& e, Frame& frame, Target& target, uint64_t loop, bool followed);
    bool runChoose(const rules::Element& e, Frame& frame, Target& target, uint64_t loop, bool followed);

    // place.cpp
    bool placeHead(const rules::Element& e, Frame& frame, Target& target, uint64_t key, bool followed);
    bool placeGrown(const rules::Element& e, Frame& frame, const Target& target, uint64_t key);
    void annotate(const rules::Element& e, Frame& frame, uint64_t key);
    /// Grows the element on `host`; it becomes a child of `target`'s node.
    bool placeOn(ShapeId host, const rules::Element& e, Frame& frame, const Target& target, uint64_t key);
    ShapeId hostOf(const ElementFacts& facts, const Frame& frame, const Target& target, const Place& place) const;
    std::vector<uint32_t> openJoints(const rules::Attribute& at, ShapeId host, const Place& place);
    uint32_t jointNamed(const rules::Expr& expr, ShapeId host, const Place& place);
    uint32_t theirJoint(const ElementFacts& facts, const Joint& ours, const Mat3& axes, const Place& place);
    rules::Joint jointShares(uint32_t joint, uint32_t jointSet) const;
    void remember(const rules::Element& e, const Frame& frame, ShapeId id, uint32_t ours);

    // split.cpp
    bool runSplit(const rules::Split& split, const Frame& frame);

    // content.cpp
    ElementFacts& factsOf(const rules::Element& e);
    uint32_t labelOf(const rules::Element& e);
    uint32_t jointSetOf(const rules::Element& e);
    bool readLooks(const rules::Element& e, const ElementFacts& facts, const Place& place, Looks& out);
    void checkNoise(const Displacement& noise, syntax::SourceSpan span);
    bool inBounds(const rules::Element& e, const ElementFacts& facts, const Looks& looks);
    void readAttribute(const rules::Attribute& a, const Place& place, Looks& out);
    std::string nameOfColor(const rules::Expr& e, Vec3f color, const Place& place) const;
    std::string nameOfLook(const Looks& looks, uint32_t base, const Place& place) const;
    uint32_t materialOf(const Looks& looks, const rules::Element& e, const Place& place);
    SolidValue valueOf(const rules::Solid& solid, const Place& place) const;
    uint32_t solidOf(const rules::Element& e, ElementFacts& facts, const Place& place);
    Shape shapeOf(const rules::Element& e, Looks& looks, const Place& place, uint64_t key);
    bool fill(const rules::Element& e, ShapeId id, const Frame& frame);

    // rules.cpp
    bool canGrow(const rules::Body& body, ShapeId host, const Place& place);
    bool isBeside(ShapeId shape, rules::SymbolId symbol) const;
    void runChain(uint32_t rule, ShapeId root, uint32_t generation);
    void runFinally(uint32_t rule, ShapeId root, Links& links, uint32_t generation);
    bool runLogged(const rules::Body& body, const Frame& frame, Step step);

    TreeBuilder& builder_;
    const rules::Grammar& grammar_;
    std::span<const rules::Value> params_;
    std::vector<RuleFacts> facts_;
    std::unordered_map<const rules::Element*, ElementFacts> elements_;
    std::map<std::string, uint32_t, std::less<>> labels_;
    std::map<std::array<float, 5>, uint32_t> mixedMaterials_;  ///< by colour, roughness, metalness: those of attributes
    std::vector<rules::Value> locals_;
    uint32_t chainRule_ = none;  ///< the rule whose chain is being run
};

}  // namespace sgm::derive

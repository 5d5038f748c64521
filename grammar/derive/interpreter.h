// Runs the bodies of rules: what an application of a rule adds to the tree.
// Enters: a rule and the shape it matched. Leaves: new shapes and bonds in the builder, steps in the log. Assumes
// checked rules. Recursion follows the nesting of the text, never the depth of the tree. Sources: rules.cpp matches and
// applies, bodies.cpp runs control and fills shapes, place.cpp puts them, shape_maker.cpp makes them; content
// operations cut their scopes through parts_context.h.
#pragma once

#include <array>

#include "grammar/derive/shape_maker.h"

namespace sgm::derive {

class Interpreter {
public:
    Interpreter(TreeBuilder& builder, std::span<const rules::Value> params);

    /// The root and the start's body; the root's scope is the lot's, where there is one.
    void start(const rules::Start& start, uint64_t seed, const Lot* lot);
    /// Applies the rule to a live shape, a `repeat` with its whole chain, and logs it.
    void apply(uint32_t rule, ShapeId shape, uint32_t generation);
    /// Guard apart: symbol, `beside`, chain, and a joint left for what the body grows.
    bool matches(uint32_t rule, ShapeId shape);
    /// An element whose joints are all closed on a shape.
    struct Blocked {
        const rules::Element* element = nullptr;
        ShapeId host = none;
        std::vector<uint32_t> joints;  ///< of the host
    };
    /// Notes that it grew nowhere (Derivation::closed).
    void noteClosed(const Blocked& blocked) { maker_.noteClosed(*blocked.element, blocked.host, blocked.joints); }
    /// The elements of rules that `matches` refused for their joints since the last call.
    std::vector<Blocked> takeBlocked() { return std::exchange(blocked_, {}); }
    /// Where expressions about a shape stand, drawing from its own stream.
    Place placeOf(ShapeId shape) const;
    /// True when a joint, a count or a neighbour decides whether the rule matches: it may match later.
    bool readsWorld(uint32_t rule) const { return facts_[rule].readsWorld; }

private:
    friend class PartsContext;

    /// What is known of a rule before it runs.
    struct RuleInfo {
        uint64_t hash = 0;
        bool readsWorld = false;
    };
    /// The shapes of a chain that `on` speaks of.
    struct RunState {
        ShapeId root = none, last = none, newest = none;
        std::array<std::vector<ShapeId>, faceCount> toward, placed;
        bool ownSymbol = false;  ///< `newest` was found in this step and has the rule's own symbol
    };
    /// One run of a body: the shape it speaks of, and the node that its operators join.
    struct Frame {
        ShapeId matched = none, node = none;
        uint64_t key = 0;
        Place place;
        RunState* state = nullptr;
        bool wholeContent = false;  ///< in `finally`: a newcomer without a joint fills the box of everything grown
    };
    /// What the operators of a sibling chain join: the node that holds them and the shape whose joints they name.
    struct Target {
        ShapeId node = none, host = none;
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
    bool fill(const rules::Element& e, ShapeId id, const Frame& frame);

    // place.cpp
    bool placeHead(const rules::Element& e, Frame& frame, Target& target, uint64_t key, bool followed);
    bool placeGrown(const rules::Element& e, Frame& frame, const Target& target, uint64_t key);
    void annotate(const rules::Element& e, Frame& frame, uint64_t key);
    /// Grows the element on `host`; it becomes a child of `target`'s node.
    bool placeOn(ShapeId host, const rules::Element& e, Frame& frame, const Target& target, uint64_t key);
    /// A joint of a shape that a newcomer comes to, and where the newcomer's expressions stand.
    struct Attachment {
        ShapeId host = none;
        uint32_t ours = none;  ///< index of `joint`
        Joint joint;
        Place place;
    };
    bool join(const rules::Element& e, Frame& frame, const Target& target, const Attachment& attachment);
    // face_joints.cpp
    bool placeOnFaces(ShapeId host, const rules::Element& e, Frame& frame, const Target& target, uint64_t key);
    bool cutAbove(const rules::Element& e, const Target& target, const Frame& frame, Shape shape, uint32_t ours,
                  uint32_t theirs, ShapeId host);
    void count(uint32_t local, double turn, uint64_t stream);
    ShapeId hostOf(const rules::Element& e, const Frame& frame, const Target& target, const Place& place) const;
    void remember(const rules::Element& e, const Frame& frame, ShapeId id, uint32_t ours);

    // rules.cpp
    bool canGrow(const rules::Body& body, ShapeId host, const Place& place, std::vector<Blocked>& blocked);
    void runChain(uint32_t rule, ShapeId root, uint32_t generation);
    void runFinally(uint32_t rule, ShapeId root, RunState& state, uint32_t generation);
    bool runLogged(const rules::Body& body, const Frame& frame, Step step);

    TreeBuilder& builder_;
    const rules::Grammar& grammar_;
    std::span<const rules::Value> params_;
    std::vector<RuleInfo> facts_;
    ShapeMaker maker_;
    std::vector<rules::Value> locals_;
    std::vector<uint64_t> series_;  ///< by local that counts: the stream of its repetition
    std::vector<Blocked> blocked_;
    uint32_t chainRule_ = none;  ///< the rule whose chain is being run
};

}  // namespace sgm::derive

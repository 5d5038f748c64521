// The slots of a graph: numbers that may change, found by their keys.
// Enters: keys and values, one after the other. Leaves: ids. Assumes that a shape's numbers are mostly made together:
// slots of one path in a row are found by the path, once for all of them. Graphs of many shapes are far larger than the
// caches: what is certain to be new isn't looked for, and is entered in the tables of hashes when something has to be.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "modeler/core/pages.h"
#include "modeler/field/hash_index.h"

namespace sgm::field {

using NodeId = uint32_t;
/// Index into a graph's constants table.
using SlotId = uint32_t;

/// What names a number across re-derivations: the hashed path of the shape it belongs to, and the attribute.
struct SlotKey {
    uint64_t path = 0;       ///< the shape's stream key (grammar/derive)
    uint64_t attribute = 0;  ///< hashText of the attribute's name and component, "size.x"
    friend bool operator==(const SlotKey&, const SlotKey&) = default;
};

class SlotTable {
public:
    static constexpr SlotId absent = HashIndex::none;

    void reserve(size_t slots, size_t paths);
    std::array<UnusedMemory, 4> unusedMemory() const {
        return {unusedOf(values_), unusedOf(keys_), unusedOf(nodes_), unusedOf(runs_)};
    }
    /// Says that no slot has a key of this path so far.
    void beginPath(uint64_t path) { remember(path, absent); }
    /// The slot of the key, or `absent`.
    SlotId find(const SlotKey& key);
    /// Adds the slot of a key that isn't there yet.
    SlotId add(const SlotKey& key, float value, NodeId node);
    /// Adds a slot without a path, which nobody finds.
    SlotId add(float value, NodeId node) { return append({}, value, node); }
    /// Adds slots of one path by attribute, whose nodes follow each other; nothing where one is known already or they
    /// don't go on where the path's others end.
    std::optional<SlotId> addRow(uint64_t path, std::span<const uint64_t> attributes, std::span<const float> values,
                                 NodeId firstNode);
    /// Makes place for so many rows of `length` slots, each of a path that has none so far; they hold anything until
    /// `setRow`. The first slot.
    SlotId addRows(size_t rows, uint32_t length);
    /// Fills a row that begins at `first`; from any thread.
    void setRow(SlotId first, uint64_t path, std::span<const uint64_t> attributes, std::span<const float> values,
                NodeId firstNode);
    void setValue(SlotId id, float value) { values_[id] = value; }

    NodeId nodeOf(SlotId id) const { return nodes_[id]; }
    std::span<const float> values() const { return values_; }
    std::span<const SlotKey> keys() const { return keys_; }

private:
    static constexpr uint32_t longestRun = 256;  ///< is searched one by one, from where the last one was found

    /// Slots in a row whose keys have the same path.
    struct Run {
        SlotId first = 0;
        uint32_t count = 0;
        bool hasMore = false;  ///< the path has slots elsewhere, which `later_` knows
    };
    /// A run that was asked for lately, and a bit for each attribute that it may have.
    struct Recent {
        bool isUsed = false;
        uint64_t path = 0;
        uint32_t run = absent;  ///< absent while the path has no slot
        uint32_t next = 0;      ///< in the run, after the slot that was found last
        std::array<uint64_t, 16> attributes{};

        uint64_t& word(uint64_t attribute) { return attributes[attribute >> 6 & 15]; }
        static uint64_t bit(uint64_t attribute) { return uint64_t{1} << (attribute & 63); }
        bool mayHave(uint64_t attribute) { return (word(attribute) & bit(attribute)) != 0; }
        void note(uint64_t attribute) { word(attribute) |= bit(attribute); }
    };

    SlotId append(const SlotKey& key, float value, NodeId node);
    Recent& recentOf(uint64_t path);
    Recent& remember(uint64_t path, uint32_t run);
    Run& runOf(Recent& recent);
    void enterRuns();
    SlotId find(Recent& recent, const SlotKey& key) const;

    PageVector<float> values_;
    PageVector<SlotKey> keys_;
    PageVector<NodeId> nodes_;
    PageVector<Run> runs_;
    HashIndex runIndex_, later_;
    size_t entered_ = 0;  ///< so many runs are in `runIndex_`
    std::array<Recent, 4> recent_;
    uint32_t oldest_ = 0;  ///< of `recent_`
};

}  // namespace sgm::field

#include "modeler/field/slot_table.h"

#include <algorithm>

#include "modeler/core/random.h"

namespace sgm::field {
namespace {

uint64_t hashOf(const SlotKey& key) { return combine(key.path, key.attribute); }

}  // namespace

void SlotTable::reserve(size_t slots, size_t paths) {
    values_.reserve(values_.size() + slots);
    keys_.reserve(keys_.size() + slots);
    nodes_.reserve(nodes_.size() + slots);
    runs_.reserve(runs_.size() + paths);
}

SlotTable::Recent& SlotTable::remember(uint64_t path, uint32_t run) {
    Recent& recent = recent_[oldest_];
    oldest_ = (oldest_ + 1) % recent_.size();
    recent = {true, path, run, 0, {}};
    if (run != absent) recent.attributes.fill(~uint64_t{0});
    return recent;
}

/// Enters the runs that were begun since in the table of hashes.
void SlotTable::enterRuns() {
    for (; entered_ < runs_.size(); ++entered_)
        runIndex_.insert(mix(keys_[runs_[entered_].first].path), static_cast<uint32_t>(entered_));
}

SlotTable::Recent& SlotTable::recentOf(uint64_t path) {
    for (Recent& recent : recent_)
        if (recent.path == path && recent.isUsed) return recent;
    enterRuns();
    return remember(path,
                    runIndex_.find(mix(path), [&](uint32_t run) { return keys_[runs_[run].first].path == path; }));
}

/// The run of a path to which a slot is going to be added.
SlotTable::Run& SlotTable::runOf(Recent& recent) {
    if (recent.run == absent) {
        recent.run = static_cast<uint32_t>(runs_.size());
        runs_.push_back({static_cast<SlotId>(values_.size()), 0, false});
    }
    return runs_[recent.run];
}

SlotId SlotTable::find(Recent& recent, const SlotKey& key) const {
    if (recent.run == absent || !recent.mayHave(key.attribute)) return absent;
    const Run& run = runs_[recent.run];
    const auto foundIn = [&](const SlotKey* from, const SlotKey* to) -> const SlotKey* {
        const auto at = std::find_if(from, to, [&](const SlotKey& k) { return k.attribute == key.attribute; });
        return at == to ? nullptr : at;
    };
    // Numbers are mostly asked for in the order in which they were made.
    const SlotKey *const begin = keys_.data() + run.first, *const next = begin + recent.next;
    const SlotKey* found = foundIn(next, begin + run.count);
    if (!found) found = foundIn(begin, next);
    if (found) {
        recent.next = static_cast<uint32_t>(found - begin) + 1;
        return static_cast<SlotId>(found - keys_.data());
    }
    if (!run.hasMore) return absent;
    return later_.find(hashOf(key), [&](SlotId id) { return keys_[id] == key; });
}

SlotId SlotTable::find(const SlotKey& key) { return find(recentOf(key.path), key); }

SlotId SlotTable::append(const SlotKey& key, float value, NodeId node) {
    values_.push_back(value);
    keys_.push_back(key);
    nodes_.push_back(node);
    return static_cast<SlotId>(values_.size() - 1);
}

SlotId SlotTable::add(const SlotKey& key, float value, NodeId node) {
    Recent& recent = recentOf(key.path);
    recent.note(key.attribute);
    Run& run = runOf(recent);
    const auto next = static_cast<SlotId>(values_.size());
    if (run.first + run.count == next && run.count < longestRun) {
        ++run.count;
    } else {
        run.hasMore = true;
        later_.insert(hashOf(key), next);
    }
    return append(key, value, node);
}

std::optional<SlotId> SlotTable::addRow(uint64_t path, std::span<const uint64_t> attributes,
                                        std::span<const float> values, NodeId firstNode) {
    Recent& recent = recentOf(path);
    Run& run = runOf(recent);
    const auto first = static_cast<SlotId>(values_.size()), count = static_cast<uint32_t>(attributes.size());
    const bool goesOn = run.first + run.count == first && !run.hasMore;
    const auto isKnown = [&](uint64_t attribute) { return find(recent, {path, attribute}) != absent; };
    if (!goesOn || run.count + count > longestRun || std::any_of(attributes.begin(), attributes.end(), isKnown))
        return {};
    run.count += count;
    for (const uint64_t attribute : attributes) recent.note(attribute);
    values_.resize(first + count);
    keys_.resize(first + count);
    nodes_.resize(first + count);
    setRow(first, path, attributes, values, firstNode);
    return first;
}

SlotId SlotTable::addRows(size_t rows, uint32_t length) {
    const size_t first = values_.size(), run = runs_.size();
    values_.resize(first + rows * length);
    keys_.resize(first + rows * length);
    nodes_.resize(first + rows * length);
    runs_.resize(run + rows);
    for (size_t i = 0; i < rows; ++i) runs_[run + i] = {static_cast<SlotId>(first + i * length), length, false};
    return static_cast<SlotId>(first);
}

void SlotTable::setRow(SlotId first, uint64_t path, std::span<const uint64_t> attributes, std::span<const float> values,
                       NodeId firstNode) {
    std::copy(values.begin(), values.end(), values_.data() + first);
    for (uint32_t i = 0; i < attributes.size(); ++i) {
        keys_[first + i] = {path, attributes[i]};
        nodes_[first + i] = firstNode + i;
    }
}

}  // namespace sgm::field

#include "grammar/pipeline/placed_models.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "grammar/lower/part_texts.h"
#include "grammar/rules/params.h"

namespace sgm::pipeline {

using derive::Derivation;

namespace {

constexpr uint32_t deepest = 8;  ///< objects within objects

/// The lowest point of what was derived, in its own frame.
double footOf(const Derivation& derivation) {
    const derive::ShapeTree& tree = derivation.tree;
    const derive::Scope box = derivation.terminals() > 0 ? tree.contentBox(0) : tree.shapes[0].scope;
    double foot = box.centre.y;
    for (int corner = 0; corner < 8; ++corner)
        foot = std::min(foot, box.point({corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0}).y);
    return foot;
}

}  // namespace

bool hasSolids(const PlacedModel& object) { return object.derivation->terminals() > 0 || object.holds.empty(); }

Status PlacedModels::derive() {
    std::vector<uint32_t> open = take(model_, 1, ground_);
    if (context_.progress) context_.progress->begin("objects", 0);
    while (!open.empty()) {
        if (objects_[open.front()].depth > deepest)
            return syntax::errorAt(model_.grammar->starts[objects_[open.front()].inputs.start].span, Error::Kind::Input,
                                   fmt::format("objects hold objects more than {} deep: '{}' may hold itself", deepest,
                                               nameOf(objects_[open.front()])));
        if (const Status s = deriveLevel(open); !s.ok()) return s;
        std::vector<uint32_t> next;
        for (const uint32_t index : open) {
            if (objects_[index].same != index) continue;
            std::vector<uint32_t> holds;
            const auto fresh = take(*objects_[index].derivation, objects_[index].depth + 1, holds);
            objects_[index].holds = std::move(holds);
            next.insert(next.end(), fresh.begin(), fresh.end());
        }
        open = std::move(next);
    }
    return Done{};
}

const std::string& PlacedModels::nameOf(const PlacedModel& object) const {
    return model_.grammar->symbols[model_.grammar->starts[object.inputs.start].symbol].name;
}

/// The objects that a derivation holds; those that weren't known are returned.
std::vector<uint32_t> PlacedModels::take(const Derivation& from, uint32_t depth, std::vector<uint32_t>& holds) {
    std::vector<uint32_t> fresh;
    for (size_t i = 0; i < from.objects.size(); ++i) {
        const uint32_t known = inputs_.put(from.objects[i]);
        holds.push_back(known);
        if (known < objects_.size()) continue;
        PlacedModel& object = objects_.emplace_back();
        object.inputs = from.objects[i];
        object.depth = depth;
        object.same = known;
        fresh.push_back(known);
    }
    return fresh;
}

/// Derives objects of one depth: of those that chance alone tells apart one first, and the others only where it
/// used chance.
Status PlacedModels::deriveLevel(const std::vector<uint32_t>& open) {
    std::vector<uint32_t> first, rest;
    for (const uint32_t i : open)
        (firstAlike_.try_emplace(objects_[i].inputs.hash(false), i).second ? first : rest).push_back(i);
    if (const Status s = deriveThese(first); !s.ok()) return s;
    std::vector<uint32_t> differing;
    for (const uint32_t i : rest) {
        const uint32_t alike = firstAlike_.at(objects_[i].inputs.hash(false));
        if (objects_[alike].usedChance)
            differing.push_back(i);
        else
            objects_[i].same = alike;
    }
    return deriveThese(differing);
}

Status PlacedModels::deriveThese(const std::vector<uint32_t>& these) {
    std::vector<Status> done(these.size(), Done{});
    inParallel(these.size(), [&](size_t i, Context& own) {
        PlacedModel& object = objects_[these[i]];
        derive::Options options;
        options.start = object.inputs.start;
        options.params = object.inputs.params;
        options.seed = object.inputs.seed;
        options.budget = budget_;
        options.isPlaced = true;
        options.lot = object.inputs.lot;
        auto derived = derive::derive(model_.grammar, options, own.progress);
        if (derived.ok())
            object.derivation = std::move(*derived);
        else
            done[i] = derived.error();
    });
    if (cancelled(context_.progress)) return cancelledError();
    for (size_t i = 0; i < these.size(); ++i) {
        if (!done[i].ok()) return done[i];
        PlacedModel& object = objects_[these[i]];
        object.usedChance = object.derivation->usedChance;
        object.foot_m = footOf(*object.derivation);
        selections_.add(std::exchange(object.derivation->selections, {}));
        const syntax::Diagnostics found = derive::warnings(*object.derivation);
        warnings_.insert(warnings_.end(), found.all().begin(), found.all().end());
    }
    return Done{};
}

Pose PlacedModels::poseOf(const PlacedModel& object, const derive::Scope& scope) {
    if (object.inputs.lot) return {scope.centre, scope.axes};
    return {scope.point({0, -1, 0}) - scope.axes.y * object.foot_m, scope.axes};
}

uint64_t PlacedModels::shapesOf(uint32_t index) {
    if (const auto known = shapes_.find(index); known != shapes_.end()) return known->second;
    const PlacedModel& object = objects_[index];
    uint64_t count = object.derivation->tree.shapes.size();
    if (!object.holds.empty())
        for (const derive::Placement& inner : derive::placementsOf(*object.derivation))
            count += shapesOf(of(object.holds, inner.object));
    return shapes_[index] = count;
}

std::set<uint32_t> PlacedModels::firstOfEachStart() const {
    std::set<uint32_t> first, starts;
    for (uint32_t i = 0; i < size(); ++i)
        if (objects_[i].same == i && hasSolids(objects_[i]) && starts.insert(objects_[i].inputs.start).second)
            first.insert(i);
    return first;
}

PlacedFigures PlacedModels::figures() const {
    PlacedFigures all{0, 0, std::vector<derive::Reported>(model_.grammar->reports.size())};
    std::unordered_map<uint32_t, PlacedFigures> known;
    addFigures(model_, ground_, known, all);
    for (const auto& [index, inside] : known) all.objects += hasSolids(objects_[index]);
    return all;
}

/// Adds what a derivation holds: `known` has of each object what stands in it, itself included.
void PlacedModels::addFigures(const Derivation& derivation, const std::vector<uint32_t>& holds,
                              std::unordered_map<uint32_t, PlacedFigures>& known, PlacedFigures& sum) const {
    if (holds.empty()) return;
    for (const derive::Placement& placement : derive::placementsOf(derivation)) {
        const uint32_t index = of(holds, placement.object);
        if (!known.contains(index)) {
            const PlacedModel& object = objects_[index];
            PlacedFigures inside{0, hasSolids(object), {}};
            for (uint32_t i = 0; i < sum.reports.size(); ++i) inside.reports.push_back(object.derivation->reported(i));
            addFigures(*object.derivation, object.holds, known, inside);
            known[index] = std::move(inside);
        }
        const PlacedFigures& inside = known.at(index);
        sum.places += inside.places;
        for (size_t i = 0; i < sum.reports.size(); ++i) sum.reports[i].add(inside.reports[i]);
    }
}

syntax::Diagnostics PlacedModels::warnings() const {
    syntax::Diagnostics all;
    std::set<std::tuple<const void*, uint32_t, std::string>> said;
    std::vector<syntax::Diagnostic> found = warnings_;
    const syntax::Diagnostics missed = selections_.warnings();
    found.insert(found.end(), missed.all().begin(), missed.all().end());
    for (const syntax::Diagnostic& d : found)
        if (said.emplace(d.span.source, d.span.begin, d.message).second) all.warning(d.span, d.message, d.hint);
    return all;
}

std::map<std::string, std::string> PlacedModels::valuesOf(const PlacedModel& object) const {
    std::map<std::string, std::string> values{{"start", nameOf(object)}};
    if (object.usedChance) values["seed"] = fmt::format("{}", object.inputs.seed);
    const auto usual = rules::valuesOf(*model_.grammar, object.inputs.start);
    for (size_t i = 0; i < usual.size(); ++i)
        if (object.inputs.params[i] != usual[i])
            values["param " + model_.grammar->params[i].name] = rules::toText(object.inputs.params[i]);
    return values;
}

Result<std::vector<PlacedModels::Place>> PlacedModels::places(uint64_t most) const {
    std::vector<Place> places;
    if (const Status s = addPlaces(model_, ground_, {}, {}, most, places); !s.ok()) return s.error();
    return places;
}

Status PlacedModels::addPlaces(const Derivation& derivation, const std::vector<uint32_t>& holds, const Pose& frame,
                               const std::string& path, uint64_t most, std::vector<Place>& places) const {
    lower::PartTexts texts(derivation);  // places of the same line share what is told of it
    for (const derive::Placement& placement : derive::placementsOf(derivation)) {
        const uint32_t index = of(holds, placement.object);
        const PlacedModel& object = objects_[index];
        Part part;
        part.path = derivation.tree.path(placement.shape);
        part.madeBy = texts.madeBy(derivation.tree.shapes[placement.shape]);
        if (!path.empty()) part.path = path + "/" + part.path.text();
        Pose local = poseOf(object, derivation.tree.shapes[placement.shape].scope);
        local.origin.y += derivation.tree.extrasOf(placement.shape)->lift_m;
        part.pose = {frame.origin + frame.axes * local.origin, frame.axes * local.axes};
        places.push_back({index, part});
        if (places.size() > most)
            return syntax::errorAt(derivation.tree.shapes[placement.shape].span, Error::Kind::Budget,
                                   fmt::format("there are more than {} places of objects (--max-shapes)", most));
        if (cancelled(context_.progress)) return cancelledError();
        if (object.holds.empty()) continue;
        const Status inner = addPlaces(*object.derivation, object.holds, part.pose, part.path, most, places);
        if (!inner.ok()) return inner;
    }
    return Done{};
}

}  // namespace sgm::pipeline

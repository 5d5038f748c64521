// The objects that `place` puts into a model, derived: those that objects place among them, each once.
// Enters: a derivation. Leaves: derivations of its objects, and how they stand. Assumes that nothing but its inputs
// decides an object, so that objects may be derived in any order and at the same time.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <set>
#include <unordered_map>
#include <vector>

#include "grammar/derive/derive.h"
#include "grammar/pipeline/context.h"
#include "modeler/core/parallel.h"

namespace sgm::pipeline {

/// An object with what was made of it.
struct PlacedModel {
    derive::PlacedObject inputs;
    uint32_t depth = 1;  ///< of the objects around it, the model counting as 0
    uint32_t same = 0;   ///< the object that stands for it: another one where chance alone would tell them apart
    std::optional<derive::Derivation> derivation;
    std::vector<uint32_t> holds;  ///< by index in its Derivation::objects: the object here
    bool usedChance = false;      ///< its derivation drew
    double foot_m = 0;            ///< its lowest point, in its own frame
};

/// Whether the object has solids of its own, or should have: it holds no others.
bool hasSolids(const PlacedModel& object);

/// What the objects at all places of a model come to.
struct PlacedFigures {
    uint64_t objects = 0, places = 0;       ///< different objects and their places, of those with solids of their own
    std::vector<derive::Reported> reports;  ///< by index in Grammar::reports
};

/// All objects of a model, in the order in which they were found. The model has to outlive it.
class PlacedModels {
public:
    PlacedModels(const derive::Derivation& model, const derive::Budget& budget, Context& context)
        : model_(model), budget_(budget), context_(context) {}

    /// Derives them on the context's threads; the budget is of each. Error::Input, located, for one that can't be
    /// derived or holds itself.
    Status derive();
    size_t size() const { return objects_.size(); }
    const PlacedModel& operator[](uint32_t index) const { return objects_[index]; }
    /// The object that the model (or an object of it) holds under that index, or another one that is like it.
    uint32_t of(const std::vector<uint32_t>& holds, uint32_t index) const { return objects_[holds[index]].same; }
    /// By index in the model's own objects: the object here.
    const std::vector<uint32_t>& ofModel() const { return ground_; }
    const std::string& nameOf(const PlacedModel& object) const;
    /// From the object's frame to that of what holds it: its foot on the middle of the scope's foot, or, on a lot, its
    /// scope on that scope.
    static Pose poseOf(const PlacedModel& object, const derive::Scope& scope);
    /// What decides the object, for readers: `start`, `seed` where chance decides something, `param NAME` for those
    /// that differ from the start's own.
    std::map<std::string, std::string> valuesOf(const PlacedModel& object) const;
    /// One place: which object, and the shape that holds it, whose pose takes the object's frame to the model's.
    struct Place {
        uint32_t object = 0;
        Part part;
    };
    /// All places in tree order, those in objects after the one that holds them. Error::Budget for more than `most`.
    Result<std::vector<Place>> places(uint64_t most) const;
    /// The first object of each start that has solids of its own: what is reported of it holds for others like it.
    std::set<uint32_t> firstOfEachStart() const;
    /// Of all places, those in objects too. For derived objects that `release` hasn't taken.
    PlacedFigures figures() const;
    /// Shapes of the object with those of all that it holds.
    uint64_t shapesOf(uint32_t index);
    /// Which places of the text picked something in one of them.
    const derive::Selections& selections() const { return selections_; }
    /// What derive::warnings says of them, each once.
    syntax::Diagnostics warnings() const;
    /// The object's derivation, taken out of it: it has none any more. May be called for different objects at once.
    derive::Derivation release(uint32_t index) {
        derive::Derivation released = std::move(*objects_[index].derivation);
        objects_[index].derivation.reset();
        return released;
    }
    /// Calls work(index, context) for every index below `count`, several at a time.
    template <class Work>
    void inParallel(size_t count, Work&& work) const {
        const int all = threadCount(context_.threads);
        const int outer = static_cast<int>(std::min<size_t>(count, static_cast<size_t>(all)));
        if (outer == 0) return;
        parallelFor(count, outer, context_.progress, [&](size_t i, int) {
            Progress progress(context_.progress);  // whose stages nobody sees: those of several objects run at once
            Context own{&progress, std::max(1, all / outer), {}};
            work(i, own);
        });
    }

private:
    void addFigures(const derive::Derivation& derivation, const std::vector<uint32_t>& holds,
                    std::unordered_map<uint32_t, PlacedFigures>& known, PlacedFigures& sum) const;
    std::vector<uint32_t> take(const derive::Derivation& from, uint32_t depth, std::vector<uint32_t>& holds);
    Status deriveLevel(const std::vector<uint32_t>& open);
    Status deriveThese(const std::vector<uint32_t>& these);
    Status addPlaces(const derive::Derivation& derivation, const std::vector<uint32_t>& holds, const Pose& frame,
                     const std::string& path, uint64_t most, std::vector<Place>& places) const;

    const derive::Derivation& model_;
    const derive::Budget& budget_;
    Context& context_;
    derive::PlacedObjects inputs_;
    std::deque<PlacedModel> objects_;
    std::vector<uint32_t> ground_;
    std::unordered_map<uint64_t, uint32_t> firstAlike_;
    std::unordered_map<uint32_t, uint64_t> shapes_;  ///< of an object with those that it holds
    std::vector<syntax::Diagnostic> warnings_;
    derive::Selections selections_;  ///< of all objects: what one of them has is found
};

}  // namespace sgm::pipeline

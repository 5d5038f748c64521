#include "grammar/derive/recording.h"

#include <algorithm>

namespace sgm::derive {

void Recording::begin(Piece piece) {
    piece.from.answer = answers_.size();
    running_ = pieces_.size();
    pieces_.push_back(piece);
}

void Recording::finish(const Piece::Place& end) {
    last_ = end;
    last_.answer = answers_.size();
}

bool Recording::answer(const std::vector<uint32_t>& asked, std::vector<uint32_t>& open) {
    if (!replaying_) {
        for (const auto* list : {&asked, static_cast<const std::vector<uint32_t>*>(&open)}) {
            answers_.push_back(static_cast<uint32_t>(list->size()));
            answers_.insert(answers_.end(), list->begin(), list->end());
        }
        return true;
    }
    const auto read = [&](std::vector<uint32_t>& list) {
        const uint32_t place = next(at_.answer, end_.answer);
        if (place == none) return false;
        const auto first = answers_.begin() + static_cast<ptrdiff_t>(at_.answer);
        list.assign(first, first + answers_[place]);
        at_.answer += list.size();
        return true;
    };
    std::vector<uint32_t> then;
    return read(then) && read(open) && then == asked;
}

std::optional<JointIndex::Entry> MadeNotes::partnerOf(JointIndex::Entry at) const {
    const auto before = [](const Contact& m, JointIndex::Entry e) {
        return std::pair(m.at.shape, m.at.joint) < std::pair(e.shape, e.joint);
    };
    const auto found = std::lower_bound(contacts_.begin(), contacts_.end(), at, before);
    if (found == contacts_.end() || !(found->at == at)) return std::nullopt;
    return found->partner;
}

void Recording::beginReplay(size_t shapes) {
    replaying_ = true;
    ++turn_;
    changes_.begin(shapes);
}

Piece& Recording::enter(size_t piece) {
    running_ = piece;
    at_ = pieces_[piece].from;
    end_ = piece + 1 < pieces_.size() ? pieces_[piece + 1].from : last_;
    return pieces_[piece];
}

uint32_t Recording::nextSolid() {
    while (at_.solid < end_.solid && made_.isSharedSolid(at_.solid)) ++at_.solid;
    return next(at_.solid, end_.solid);
}

bool Recording::complete() {
    return nextShape() == none && nextStep() == none && nextExtras() == none && nextSolid() == none &&
           nextMate() == none && at_.answer == end_.answer;
}

void ShapeChanges::begin(size_t shapes) {
    changes_.resize(shapes, 0);
    for (const ShapeId id : marked_) changes_[id] = 0;
    marked_.clear();
    changed_.clear();
    solids_.clear();
}

void ShapeChanges::add(const ShapeTree& tree, ShapeId id, uint8_t what) {
    constexpr uint8_t own = LookChanged | Moved | Turned | Values;
    if (changes_[id] == 0) marked_.push_back(id);
    if ((changes_[id] & own) == 0) changed_.push_back(id);
    changes_[id] |= what;
    for (ShapeId s = tree.shapes[id].parent; s != none && (changes_[s] & Below) == 0; s = tree.shapes[s].parent) {
        if (changes_[s] == 0) marked_.push_back(s);
        changes_[s] |= Below;
    }
}

}  // namespace sgm::derive

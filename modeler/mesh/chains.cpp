#include "modeler/mesh/chains.h"

namespace sgm::mesh {
namespace {

/// Border edges by the vertices they meet in.
class ChainTracer {
public:
    explicit ChainTracer(const SurfaceRegions& regions)
        : regions_(regions), begin_(regions.borderVertices.size() + 1), used_(regions.borders.size()) {
        for (const BorderEdge& e : regions.borders) ++begin_[placeOf(e.a) + 1], ++begin_[placeOf(e.b) + 1];
        for (size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
        at_.resize(begin_.back());
        std::vector<uint32_t> next(begin_.begin(), begin_.end() - 1);
        for (uint32_t i = 0; i < regions.borders.size(); ++i)
            for (const uint32_t v : {regions.borders[i].a, regions.borders[i].b}) at_[next[placeOf(v)]++] = i;
    }

    Chains trace() {
        found_.placeOf.assign(regions_.borderVertices.size(), Chains::none);
        for (uint32_t place = 0; place < regions_.borderVertices.size(); ++place) {
            if (!isNode(place)) continue;
            for (uint32_t i = begin_[place]; i < begin_[place + 1]; ++i)
                if (!used_[at_[i]]) follow(at_[i], regions_.borderVertices[place]);
        }
        for (uint32_t i = 0; i < used_.size(); ++i)
            if (!used_[i]) follow(i, regions_.borders[i].a);
        listByRegion();
        return std::move(found_);
    }

private:
    uint32_t placeOf(uint32_t v) const { return regions_.ofVertex[v] & ~SurfaceRegions::borderBit; }
    bool isNode(uint32_t place) const { return begin_[place + 1] - begin_[place] != 2; }

    /// The chain that leaves `from` along an edge.
    void follow(uint32_t edge, uint32_t from) {
        const BorderEdge& first = regions_.borders[edge];
        Chain chain{static_cast<uint32_t>(found_.vertices.size()), 0, first.left, first.right, false};
        if (first.a != from) std::swap(chain.left, chain.right);
        found_.vertices.push_back(from);
        uint32_t v = from;
        for (;;) {
            used_[edge] = true;
            const BorderEdge& e = regions_.borders[edge];
            v = e.a == v ? e.b : e.a;
            if (v == from && !isNode(placeOf(v))) {
                chain.closed = true;
                break;
            }
            found_.vertices.push_back(v);
            const uint32_t place = placeOf(v);
            if (isNode(place)) break;
            edge = at_[begin_[place]] == edge ? at_[begin_[place] + 1] : at_[begin_[place]];
        }
        chain.end = static_cast<uint32_t>(found_.vertices.size());
        for (uint32_t i = chain.begin + (chain.closed ? 0 : 1); i < chain.end - (chain.closed ? 0 : 1); ++i)
            found_.placeOf[placeOf(found_.vertices[i])] = i;
        found_.chains.push_back(chain);
    }

    void listByRegion() {
        std::vector<uint32_t>& begin = found_.chainsOfBegin;
        begin.assign(regions_.count() + 1, 0);
        for (const Chain& c : found_.chains) ++begin[c.left + 1], ++begin[c.right + 1];
        for (size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
        found_.chainsOf.resize(begin.back());
        std::vector<uint32_t> next(begin.begin(), begin.end() - 1);
        for (uint32_t i = 0; i < found_.chains.size(); ++i)
            for (const uint32_t region : {found_.chains[i].left, found_.chains[i].right})
                found_.chainsOf[next[region]++] = i;
    }

    const SurfaceRegions& regions_;
    std::vector<uint32_t> begin_, at_;  ///< border edges by the place of their ends
    std::vector<bool> used_;
    Chains found_;
};

}  // namespace

Chains findChains(const SurfaceRegions& regions) { return ChainTracer(regions).trace(); }

}  // namespace sgm::mesh

#include "tests/bench/bars.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "tests/bench/report.h"

namespace sgm::bench {
namespace {

constexpr double noSlowerAtDouble = 1.7;  ///< at 512 the sweep must be so many times farther behind than asked at 256

/// How many times faster than the dense sweep (and OpenVDB, where asked) a scene has to be at 256.
struct RatioAim {
    const char* scene;
    double dense;
    bool same512;  ///< at 512 the same, for fractals' surface grows faster
    double openvdb;
};
constexpr RatioAim ratioAims[] = {{"S1", 9, false, 4},   {"S2-csg-4", 12, false, 4}, {"S2-folded-4", 1, true, 2.8},
                                  {"S3", 22, false, 50}, {"S4", 10, false, 20},      {"S5", 19, false, 0},
                                  {"S6", 80, false, 0},  {"S7", 80, false, 0},       {"S9", 5, true, 0}};

class Judge {
public:
    Judge(const std::vector<Measurement>& measurements, const Limits& limits) : all_(measurements), limits_(limits) {}

    std::vector<Bar> bars() {
        for (const int resolution : {256, 512})
            for (const RatioAim& aim : ratioAims) againstDense(aim, resolution);
        add("dense / total, the worst of all scenes and resolutions", 1, true,
            worst(true, [](const auto& m) { return m.dense.seconds / m.totalSeconds; }));
        for (const RatioAim& aim : ratioAims)
            if (aim.openvdb > 0) againstOpenVdb(aim);
        of("S3: ns a triangle at 256", 20, false, "S3", 256, [](const auto& m) { return m.nsPerTriangle(); });
        growth();
        for (const char* scene : {"S3", "S4", "S5", "S6", "S7"})
            of(fmt::format("{}: one thread / two threads at 512", scene), 1.85, true, scene, 512,
               [](const auto& m) { return m.oneThreadSeconds / m.totalSeconds; });
        add("sample / its operations alone, the worst", 3, false,
            worst(false, [](const auto& m) { return m.fieldOverLeast(); }));
        add("join / writing its output, the worst", 3, false,
            worst(false, [&](const auto& m) { return polygonizeOverWrite(m, limits_); }));
        of("S3: bytes a triangle at 512", 60, false, "S3", 512, [](const auto& m) { return m.bytesPerTriangle(); });
        of("S3: GB at 1024", 1.5, false, "S3", 1024,
           [](const auto& m) { return 1e-9 * static_cast<double>(m.peakBytes); });
        of("S5: GB at 2048", 4, false, "S5", 2048,
           [](const auto& m) { return 1e-9 * static_cast<double>(m.peakBytes); });
        return std::move(bars_);
    }

private:
    using Figure = std::function<double(const Measurement&)>;
    struct Found {
        double value = 0;
        std::string where;
    };

    const Measurement* find(std::string_view scene, int resolution) const {
        const auto at = std::find_if(all_.begin(), all_.end(), [&](const Measurement& m) {
            return m.scene == scene && m.resolution == resolution;
        });
        return at == all_.end() ? nullptr : &*at;
    }

    void add(std::string what, double aim, bool atLeast, Found found) {
        bars_.push_back({std::move(what), aim, atLeast, found.value, std::move(found.where)});
    }
    void of(std::string what, double aim, bool atLeast, std::string_view scene, int resolution, const Figure& figure) {
        const Measurement* m = find(scene, resolution);
        add(std::move(what), aim, atLeast, {m ? figure(*m) : 0, ""});
    }

    void againstDense(const RatioAim& aim, int resolution) {
        const Measurement* m = find(aim.scene, resolution);
        Found found;
        if (m && m->dense.seconds > 0)
            found = {m->ratio(),
                     fmt::format("fused {:.1f}, bounds alone {:.1f}{}", m->fused.seconds / m->totalSeconds,
                                 m->tight.seconds / m->totalSeconds, m->handWritten ? "" : "; swept by tape")};
        const double times = resolution == 256 || aim.same512 ? 1 : noSlowerAtDouble;
        add(fmt::format("{}: dense / total at {}", aim.scene, resolution), aim.dense * times, true, found);
    }

    /// The figure that is farthest on the wrong side; figures of 0 weren't measured.
    Found worst(bool least, const Figure& figure) const {
        Found found;
        for (const Measurement& m : all_) {
            const double value = figure(m);
            if (value <= 0 || (found.value > 0 && (least ? value >= found.value : value <= found.value))) continue;
            found = {value, fmt::format("{} at {}", m.scene, m.resolution)};
        }
        return found;
    }

    void againstOpenVdb(const RatioAim& aim) {
        const Measurement* m = find(aim.scene, 256);
        Found found;
        if (m && m->openvdb.triangles > 0)
            found = {m->openvdbByHandSeconds() / m->totalSeconds,
                     fmt::format("with our sampling {:.1f}", m->openvdbSeconds() / m->totalSeconds)};
        add(fmt::format("{}: OpenVDB, blocks skipped / total at 256", aim.scene), aim.openvdb, true, found);
    }

    void growth() {
        const Measurement *s3 = find("S3", 256), *s8 = find("S8", 256);
        add("S8 / S3 at 256: ten times the spheres, the same surface", 1.5, false,
            {s3 && s8 ? s8->totalSeconds / s3->totalSeconds : 0, ""});
        for (const char* scene : {"S1", "S3", "S4", "S5", "S6", "S7", "S8"}) {
            const Measurement *coarse = find(scene, 256), *fine = find(scene, 512);
            add(fmt::format("{}: total at 512 / at 256", scene), 4.3, false,
                {coarse && fine ? fine->totalSeconds / coarse->totalSeconds : 0, ""});
        }
    }

    const std::vector<Measurement>& all_;
    const Limits& limits_;
    std::vector<Bar> bars_;
};

}  // namespace

std::vector<Bar> judge(const std::vector<Measurement>& measurements, const std::vector<DragResult>& drags,
                       const Limits& limits) {
    std::vector<Bar> bars = Judge(measurements, limits).bars();
    for (const DragResult& d : drags)
        bars.push_back({fmt::format("{}: dragging {} / full build at {}", d.scene, d.parameter, d.resolution), 0.05,
                        false, d.share(), ""});
    return bars;
}

std::string barLine(const Bar& bar) {
    const char* verdict = bar.measured <= 0 ? "–" : bar.reached() ? "reached" : "short";
    return fmt::format("{:7} {:58} {} {:>6.4g}  {:>8}  {}", verdict, bar.what, bar.atLeast ? "≥" : "≤", bar.aim,
                       bar.measured > 0 ? fmt::format("{:.3g}", bar.measured) : "", bar.remark);
}

}  // namespace sgm::bench

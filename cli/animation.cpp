#include "cli/animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "grammar/rules/check.h"
#include "grammar/rules/evaluate.h"

namespace sgm::cli {
namespace {

constexpr int mostFrames = 100'000;

Error usage(const std::string& text, const std::string& what) {
    return {Error::Kind::Usage, fmt::format("--animate {}: {}", text, what)};
}

/// NAME=FROM..TO:FRAMES in its parts.
struct Written {
    std::string name, from, to;
    int frames = 0;
};

Result<Written> parts(const std::string& text) {
    const size_t equals = text.find('='), colon = text.rfind(':');
    const size_t dots = equals == std::string::npos ? equals : text.find("..", equals);
    if (dots == std::string::npos || colon == std::string::npos || colon < dots)
        return usage(text, "write NAME=FROM..TO:FRAMES, as in peak=0..1:48");
    Written w{text.substr(0, equals), text.substr(equals + 1, dots - equals - 1),
              text.substr(dots + 2, colon - dots - 2), 0};
    const char* const end = text.data() + text.size();
    const auto [stop, bad] = std::from_chars(text.data() + colon + 1, end, w.frames);
    if (bad != std::errc() || stop != end || w.frames < 2 || w.frames > mostFrames)
        return usage(text, fmt::format("'{}' is no number of frames: 2 to {}", text.substr(colon + 1), mostFrames));
    return w;
}

Result<Animation::Track> track(const rules::Grammar& grammar, const std::string& text, const Written& written) {
    const auto param = std::find_if(grammar.params.begin(), grammar.params.end(),
                                    [&](const rules::Param& p) { return p.name == written.name; });
    if (param == grammar.params.end()) {
        std::vector<std::string> names;
        for (const rules::Param& p : grammar.params) names.push_back(p.name);
        const std::string near = syntax::didYouMean(written.name, names);
        return usage(text, fmt::format("no parameter is called '{}'{}", written.name,
                                       near.empty() ? "" : fmt::format(" (did you mean '{}'?)", near)));
    }
    using Kind = rules::Value::Kind;
    if (const Kind kind = param->value.kind; kind != Kind::Number && kind != Kind::Vector && kind != Kind::Color)
        return usage(text, fmt::format("'{}' has no values between others that it could run through", param->name));
    Animation::Track t;
    t.param = static_cast<uint32_t>(param - grammar.params.begin());
    for (const auto& [from, to] : {std::pair(&written.from, &t.from), std::pair(&written.to, &t.to)}) {
        auto value = rules::parseValue(*param, *from);
        if (!value.ok()) return Error{value.error().kind, fmt::format("--animate {}: {}", text, value.error().message)};
        *to = std::move(*value);
    }
    return t;
}

}  // namespace

rules::Value Animation::value(const Track& track, int frame) const {
    rules::Value v = rules::interpolate(track.from, track.to, static_cast<double>(frame) / (frames - 1));
    v.integer = track.from.integer;
    for (size_t i = 0; v.integer && i < v.count; ++i) v.n[i] = std::round(v.n[i]);
    return v;
}

std::vector<rules::Value> Animation::values(std::vector<rules::Value> values, int frame) const {
    for (const Track& t : tracks) values[t.param] = value(t, frame);
    return values;
}

std::string Animation::text(const rules::Grammar& grammar, int frame) const {
    std::string text;
    for (const Track& t : tracks)
        text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", grammar.params[t.param].name,
                            rules::toText(value(t, frame)));
    return text;
}

Result<Animation> readAnimation(const rules::Grammar& grammar, const std::vector<std::string>& texts) {
    Animation animation;
    for (const std::string& text : texts) {
        const auto written = parts(text);
        if (!written.ok()) return written.error();
        if (animation.frames && animation.frames != written->frames)
            return usage(text,
                         fmt::format("all parameters run over the same frames, and another has {}", animation.frames));
        animation.frames = written->frames;
        auto one = track(grammar, text, *written);
        if (!one.ok()) return one.error();
        for (const Animation::Track& t : animation.tracks)
            if (t.param == one->param) return usage(text, fmt::format("'{}' is animated twice", written->name));
        animation.tracks.push_back(std::move(*one));
    }
    return animation;
}

Result<std::string> frameName(const std::string& pattern, int frame, const char* option) {
    const Error wrong{Error::Kind::Usage,
                      fmt::format("'{}': with {} the name needs one number, as in roof_%04d{}", pattern, option,
                                  std::filesystem::path(pattern).extension().string())};
    std::string name;
    int numbers = 0;
    for (size_t i = 0; i < pattern.size(); ++i) {
        if (pattern[i] != '%') {
            name += pattern[i];
        } else if (pattern.compare(i, 2, "%%") == 0) {
            name += pattern[i++];
        } else {
            int width = 0;
            const bool zeros = pattern.compare(i, 2, "%0") == 0;
            for (++i; i < pattern.size() && std::isdigit(static_cast<unsigned char>(pattern[i])); ++i)
                width = std::min(width * 10 + (pattern[i] - '0'), 20);
            if (i == pattern.size() || pattern[i] != 'd') return wrong;
            name += zeros ? fmt::format("{:0{}}", frame + 1, width) : fmt::format("{:{}}", frame + 1, width);
            ++numbers;
        }
    }
    if (numbers != 1) return wrong;
    return name;
}

}  // namespace sgm::cli

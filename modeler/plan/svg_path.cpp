#include "modeler/plan/svg_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "modeler/core/conventions.h"
#include "modeler/core/printable.h"
#include "modeler/plan/read_parts.h"

namespace sgm::plan {
namespace {

constexpr int chords = 8;

bool isSeparator(char c) { return c == ' ' || c == ',' || c == '\t' || c == '\n' || c == '\r' || c == '\f'; }

void skipSeparators(std::string_view& text) {
    while (!text.empty() && isSeparator(text[0])) text.remove_prefix(1);
}

/// Follows the commands of a path.
class PathReader {
public:
    PathReader(std::string_view text, size_t most) : text_(text), most_(most) {}

    Result<std::vector<std::vector<Vec2>>> read() {
        char command = 0;
        for (skipSeparators(text_); !text_.empty(); skipSeparators(text_)) {
            if (std::isalpha(static_cast<unsigned char>(text_[0]))) {
                command = text_[0];
                text_.remove_prefix(1);
                if (command == 'Z' || command == 'z') {
                    close();
                    command = 0;
                    continue;
                }
            }
            if (command == 0 || (rings_.empty() && open_.empty() && command != 'M' && command != 'm'))
                return failed("a path must begin with M");
            if (!follow(command)) return failed("a path has a command that isn't known, or lacks a number");
            if (command == 'M') command = 'L';
            if (command == 'm') command = 'l';
            if (count_ > most_) return failed("a path has too many points");
        }
        close();
        return std::move(rings_);
    }

private:
    static Error failed(std::string_view why) { return {Error::Kind::Input, std::string(why)}; }

    bool number(double& value) {
        skipSeparators(text_);
        const auto taken = takeNumber(text_);
        if (taken) value = *taken;
        return taken.has_value();
    }
    /// A flag of an arc: one character.
    bool flag(bool& value) {
        skipSeparators(text_);
        if (text_.empty() || (text_[0] != '0' && text_[0] != '1')) return false;
        value = text_[0] == '1';
        text_.remove_prefix(1);
        return true;
    }
    bool point(Vec2& p, bool relative) {
        if (!number(p.x) || !number(p.z)) return false;
        if (relative) p = p + at_;
        return true;
    }
    void to(Vec2 p) {
        if (open_.empty()) open_.push_back(start_);
        open_.push_back(at_ = p);
        ++count_;
    }
    void close() {
        if (open_.size() > 1 && length(open_.back() - open_.front()) < 1e-9) open_.pop_back();
        if (open_.size() > 2) rings_.push_back(std::move(open_));
        open_.clear();
        at_ = start_;
    }

    bool follow(char command) {
        const bool relative = command >= 'a';
        const char kind = static_cast<char>(std::toupper(static_cast<unsigned char>(command)));
        const Vec2 mirrored = at_ * 2 - control_, from = at_;
        const char before = std::exchange(before_, kind);
        Vec2 a, b, c;
        switch (kind) {
            case 'M':
                if (!point(a, relative)) return false;
                close();
                start_ = at_ = a;
                open_.push_back(a);
                ++count_;
                return true;
            case 'L':
                return point(a, relative) && (to(a), true);
            case 'H':
                return number(a.x) && (to({a.x + (relative ? at_.x : 0), at_.z}), true);
            case 'V':
                return number(a.z) && (to({at_.x, a.z + (relative ? at_.z : 0)}), true);
            case 'C':
            case 'S':
                if (kind == 'C' ? !point(a, relative) : (a = before == 'C' || before == 'S' ? mirrored : from, false))
                    return false;
                if (!point(b, relative) || !point(c, relative)) return false;
                return curve(from, a, b, c), control_ = b, true;
            case 'Q':
            case 'T':
                if (kind == 'Q' ? !point(a, relative) : (a = before == 'Q' || before == 'T' ? mirrored : from, false))
                    return false;
                if (!point(c, relative)) return false;
                return curve(from, from + (a - from) * (2. / 3), c + (a - c) * (2. / 3), c), control_ = a, true;
            case 'A':
                return arc(relative);
            default:
                return false;
        }
    }

    void curve(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
        for (int i = 1; i <= chords; ++i) {
            const double t = static_cast<double>(i) / chords, s = 1 - t;
            to(i == chords ? d : a * (s * s * s) + b * (3 * s * s * t) + c * (3 * s * t * t) + d * (t * t * t));
        }
    }

    /// SVG 1.1, appendix F.6: from end points to the centre.
    bool arc(bool relative) {
        double rx, rz, tilt;
        bool large, sweep;
        Vec2 end;
        if (!number(rx) || !number(rz) || !number(tilt) || !flag(large) || !flag(sweep) || !point(end, relative))
            return false;
        rx = std::abs(rx), rz = std::abs(rz);
        const Vec2 from = at_, half = (from - end) * 0.5;
        if (rx < 1e-12 || rz < 1e-12 || length(half) < 1e-12) return to(end), true;
        const double co = std::cos(radians(tilt)), si = std::sin(radians(tilt));
        const Vec2 p{(co * half.x + si * half.z) / rx, (-si * half.x + co * half.z) / rz};  // on a unit circle
        const double square = dot(p, p), grow = std::sqrt(std::max(square, 1.0));
        const double off = std::sqrt(std::max(1 / square - 1, 0.0)) * (large == sweep ? -1 : 1);
        const Vec2 q = p * (1 / grow), centre{off * q.z, -off * q.x};
        const double begin = std::atan2(q.z - centre.z, q.x - centre.x);
        double turn = std::atan2(-q.z - centre.z, -q.x - centre.x) - begin;
        if (sweep && turn < 0) turn += 2 * pi;
        if (!sweep && turn > 0) turn -= 2 * pi;
        const Vec2 middle = (from + end) * 0.5;
        for (int i = 1; i <= chords; ++i) {
            const double angle = begin + turn * i / chords;
            const Vec2 r{(centre.x + std::cos(angle)) * rx * grow, (centre.z + std::sin(angle)) * rz * grow};
            to(i == chords ? end : middle + Vec2{co * r.x - si * r.z, si * r.x + co * r.z});
        }
        return true;
    }

    std::string_view text_;
    const size_t most_;
    size_t count_ = 0;
    std::vector<std::vector<Vec2>> rings_;
    std::vector<Vec2> open_;
    Vec2 at_, start_, control_;
    char before_ = 0;
};

Result<SvgMatrix> matrixOf(std::string_view name, const std::vector<double>& n) {
    const size_t count = n.size();
    if (name == "translate" && (count == 1 || count == 2)) return SvgMatrix{1, 0, 0, 1, n[0], count == 2 ? n[1] : 0};
    if (name == "scale" && (count == 1 || count == 2)) return SvgMatrix{n[0], 0, 0, n[count - 1], 0, 0};
    if (name == "matrix" && count == 6) return SvgMatrix{n[0], n[1], n[2], n[3], n[4], n[5]};
    if (name == "rotate" && (count == 1 || count == 3)) {
        const double c = std::cos(radians(n[0])), s = std::sin(radians(n[0]));
        const SvgMatrix turn{c, s, -s, c, 0, 0};
        if (count == 1) return turn;
        return SvgMatrix{1, 0, 0, 1, n[1], n[2]} * turn * SvgMatrix{1, 0, 0, 1, -n[1], -n[2]};
    }
    if (name == "skewX" && count == 1) return SvgMatrix{1, 0, std::tan(radians(n[0])), 1, 0, 0};
    if (name == "skewY" && count == 1) return SvgMatrix{1, std::tan(radians(n[0])), 0, 1, 0, 0};
    return Error{Error::Kind::Input,
                 fmt::format("'{}' with {} numbers is no transform", shortened(printable(name), 32), count)};
}

}  // namespace

SvgMatrix SvgMatrix::operator*(const SvgMatrix& i) const {
    return {a * i.a + c * i.b, b * i.a + d * i.b,     a * i.c + c * i.d,
            b * i.c + d * i.d, a * i.e + c * i.f + e, b * i.e + d * i.f + f};
}

Result<std::vector<std::vector<Vec2>>> svgPath(std::string_view text, size_t most) {
    return PathReader(text, most).read();
}

Result<std::vector<double>> svgNumbers(std::string_view text, size_t most) {
    std::vector<double> numbers;
    for (skipSeparators(text); !text.empty(); skipSeparators(text)) {
        const auto number = takeNumber(text);
        if (!number || numbers.size() == most)
            return Error{Error::Kind::Input, "a list of numbers has something else, or too many"};
        numbers.push_back(*number);
    }
    return numbers;
}

Result<SvgMatrix> svgTransform(std::string_view text) {
    SvgMatrix all;
    for (skipSeparators(text); !text.empty(); skipSeparators(text)) {
        const size_t open = text.find('('), end = text.find(')');
        if (open == text.npos || end == text.npos || end < open)
            return Error{Error::Kind::Input, "a transform has no numbers in parentheses"};
        std::string_view name = text.substr(0, open);
        while (!name.empty() && isSeparator(name.back())) name.remove_suffix(1);
        const auto numbers = svgNumbers(text.substr(open + 1, end - open - 1), 6);
        if (!numbers) return numbers.error();
        const auto one = matrixOf(name, *numbers);
        if (!one) return one.error();
        all = all * *one;
        text.remove_prefix(end + 1);
    }
    return all;
}

}  // namespace sgm::plan

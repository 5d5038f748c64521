#include "viewer/render/crease_lines.h"

#include <epoxy/gl.h>

#include <algorithm>

namespace sgm::render {
namespace {

constexpr size_t batchSegments = 1u << 16;  // a draw
constexpr uint32_t endsBinding = 5;         // as in crease.vert.glsl
constexpr GLsizei cornersOfQuad = 6;        // two triangles

}  // namespace

CreaseLines::CreaseLines(std::span<const Segment> segments) : count_(segments.size()) {
    if (count_ > 0) ends_ = Buffer::of(segments);
}

Status CreaseLines::draw(const Program& program, Progress* progress) const {
    if (count_ == 0) return Done{};
    if (array_.id() == 0) {
        GLuint id = 0;
        glGenVertexArrays(1, &id);
        array_ = VertexArray(id);
    }
    program.use();
    ends_.bindStorage(endsBinding);
    for (size_t first = 0; first < count_; first += batchSegments) {
        if (cancelled(progress)) return cancelledError();
        const auto segments = static_cast<GLsizei>(std::min(batchSegments, count_ - first));
        program.set("firstSegment", static_cast<int>(first));
        glBindVertexArray(array_.id());
        glDrawArrays(GL_TRIANGLES, 0, cornersOfQuad * segments);
        finish();
    }
    return Done{};
}

}  // namespace sgm::render

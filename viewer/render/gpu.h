// The GPU without a window: an OpenGL 4.3 context over EGL, programs, buffers and render targets that free themselves.
// Enters: shader text and bytes. Leaves: bytes. Assumes one context at a time, current on the thread that made it;
// every object below must die before its context does.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "modeler/core/result.h"
#include "modeler/core/vec.h"

namespace sgm::render {

/// An OpenGL core context that needs no display: EGL's surfaceless platform, else its device platform.
class GpuContext {
public:
    /// Makes a context current on this thread; Error::Internal says what EGL lacks.
    static Result<GpuContext> create();
    GpuContext(GpuContext&& other) noexcept;
    GpuContext& operator=(GpuContext&&) = delete;
    ~GpuContext();
    /// Renderer and version, as the driver calls itself.
    std::string description() const;

private:
    GpuContext(void* display, void* context) : display_(display), context_(context) {}
    void* display_;
    void* context_;
};

/// A GL object's name and the function that frees it; move-only.
template <void (*Free)(uint32_t)>
class GpuHandle {
public:
    GpuHandle() = default;
    explicit GpuHandle(uint32_t id) : id_(id) {}
    GpuHandle(GpuHandle&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
    GpuHandle& operator=(GpuHandle&& other) noexcept {
        std::swap(id_, other.id_);
        return *this;
    }
    ~GpuHandle() {
        if (id_) Free(id_);
    }
    uint32_t id() const { return id_; }

private:
    uint32_t id_ = 0;
};

namespace detail {
void freeProgram(uint32_t id);
void freeBuffer(uint32_t id);
void freeTexture(uint32_t id);
void freeFramebuffer(uint32_t id);
void freeVertexArray(uint32_t id);
void freeRenderbuffer(uint32_t id);
}  // namespace detail

using VertexArray = GpuHandle<detail::freeVertexArray>;
using Texture = GpuHandle<detail::freeTexture>;
using Renderbuffer = GpuHandle<detail::freeRenderbuffer>;
using Framebuffer = GpuHandle<detail::freeFramebuffer>;

/// A 4 × 4 matrix by columns.
using Matrix4 = std::array<float, 16>;

/// A linked program; `set` finds a uniform by name and ignores names the compiler removed.
class Program : public GpuHandle<detail::freeProgram> {
public:
    using GpuHandle::GpuHandle;
    /// From one compute shader. The error holds the driver's log.
    static Result<Program> compute(const std::string& source);
    /// From a vertex and a fragment shader.
    static Result<Program> draw(const std::string& vertex, const std::string& fragment);

    void use() const;
    void set(const char* name, float value) const;
    void set(const char* name, int value) const;
    void set(const char* name, uint32_t value) const;
    void set(const char* name, Vec3f value) const;
    void set(const char* name, const Matrix4& matrix) const;
};

/// A buffer of plain values for shader storage, vertices or indices.
class Buffer : public GpuHandle<detail::freeBuffer> {
public:
    using GpuHandle::GpuHandle;
    static Buffer ofBytes(const void* bytes, size_t size);
    template <class T>
    static Buffer of(std::span<const T> values) {
        return ofBytes(values.data(), values.size_bytes());
    }
    /// Makes the buffer a shader storage block's `binding`.
    void bindStorage(uint32_t binding) const;
    /// Copies `size` bytes from its start; waits for the shaders that write it.
    void read(void* bytes, size_t size) const;
    template <class T>
    std::vector<T> read(size_t count) const {
        std::vector<T> values(count);
        read(values.data(), count * sizeof(T));
        return values;
    }
};

/// Words that shaders read as a usamplerBuffer: on software GL the quickest way to random words.
class TexelBuffer {
public:
    /// `wordsPerTexel` 1 (R32UI) or 4 (RGBA32UI).
    static TexelBuffer of(std::span<const uint32_t> words, int wordsPerTexel);
    /// The same memory in other texels.
    TexelBuffer as(int wordsPerTexel) const;
    /// Makes it the texture of a unit.
    void bind(uint32_t unit) const;

private:
    std::shared_ptr<const Buffer> buffer_;
    Texture texture_;
};

/// Numbers on a grid that shaders read between 0 and 1, x fastest.
class VolumeTexture {
public:
    enum class Edge { Clamp, Repeat, Nearest };  ///< beyond its ends; Nearest clamps and doesn't interpolate
    static VolumeTexture of(std::span<const uint8_t> values, Vec3i count, Edge edge = Edge::Clamp);
    /// Four numbers a voxel.
    static VolumeTexture of(std::span<const uint16_t> rgba, Vec3i count, Edge edge = Edge::Clamp);
    void bind(uint32_t unit) const;

private:
    Texture texture_;
};

/// Runs the program in use over `count` invocations of local size 64; it must compare its index with `count`.
void dispatch(size_t count);

/// True where the current context's driver has no GPU, and runs shaders on the processor.
bool softwareGl();

/// Waits until every command so far is done, so that work stays in short pieces.
void finish();

/// A colour target with depth and several samples a pixel, resolved when it is read.
struct ColorTarget {
    Framebuffer framebuffer, resolvedFramebuffer;
    Renderbuffer color, depth;
    Texture resolved;  ///< the mean of each pixel's samples, after `resolve`
    int width = 0, height = 0;

    /// `samples` is lowered to what the driver offers. Error::Internal when it refuses the format.
    static Result<ColorTarget> create(int width, int height, int samples);
    /// Draws go here until the next bind.
    void bind() const;
    void resolve() const;
    /// The mean of each pixel's samples as RGBA, bottom row first.
    std::vector<float> read() const;
};

/// An RGBA texture of display colours (8 bits, sRGB) for the screen.
class DisplayTexture {
public:
    /// Nothing where it has this size already.
    void resize(int width, int height);
    /// A part of it, (x, y) from the top left; four bytes a pixel, top row first.
    void write(std::span<const uint8_t> rgba, int x, int y, int width, int height);
    /// Makes all of it, top row first, of a resolved target of the same size; `encode` is the shader of that name.
    void encode(const ColorTarget& target, const Program& encode);
    uint32_t id() const { return texture_.id(); }
    int width() const { return width_; }
    int height() const { return height_; }
    /// RGB, top row first.
    std::vector<uint8_t> read() const;

private:
    Texture texture_;
    Framebuffer framebuffer_;
    int width_ = 0, height_ = 0;
};

/// A stack of square maps with one number a pixel: depths, or blurred functions of them.
struct MapStack {
    enum class Kind { Depth, Number };
    Texture texture;                  ///< a 2D array; depths 0 … 1 unfiltered, numbers filtered linearly
    mutable Framebuffer framebuffer;  ///< made in the context that first draws, for contexts don't share them
    Kind kind = Kind::Depth;
    int edge = 0;  ///< pixels

    static MapStack create(Kind kind, int edge, int layers);
    /// Draws go to `layer`, cleared to the farthest depth or 0, until the next bind.
    void bindCleared(int layer) const;
    /// Makes the stack the texture of a unit.
    void bindTexture(uint32_t unit) const;
};

/// Square pictures of one size, RGBA from the lowest row up, that repeat and have mip maps.
class PictureStack {
public:
    /// With `colors` the bytes are sRGB and shaders read linear light. Without pictures there is one black pixel.
    static PictureStack of(std::span<const std::vector<uint8_t>> pictures, int edge, bool colors);
    /// Makes the stack the texture of a unit.
    void bindTexture(uint32_t unit) const;

private:
    Texture texture_;
};

/// Positions, normals and a number a vertex with indices; `draw` sends triangles [first, first + count).
class TriangleBuffers {
public:
    static TriangleBuffers of(std::span<const Vec3f> positions, std::span<const Vec3f> normals,
                              std::span<const float> numbers, std::span<const Vec3<uint32_t>> triangles);
    /// Of what a shader has made.
    static TriangleBuffers of(Buffer positions, Buffer normals, Buffer numbers, Buffer indices);
    void draw(size_t first, size_t count) const;

private:
    void describe() const;

    mutable VertexArray array_;  // made in the context that first draws, for contexts don't share them
    Buffer positions_, normals_, numbers_, indices_;
};

/// One triangle that covers the target; its vertices are made in the shader.
class ScreenTriangle {
public:
    ScreenTriangle();
    void draw() const;

private:
    VertexArray array_;
};

/// Whether nearer fragments hide farther ones; of two as near the later one is seen.
void setDepthTest(bool on);

/// While it lives, draws leave depths and no colours.
class WithoutColor {
public:
    WithoutColor();
    ~WithoutColor();
    WithoutColor(const WithoutColor&) = delete;
    WithoutColor& operator=(const WithoutColor&) = delete;
};

/// While it lives, triangles are drawn as their edges, blended over what is there and a little nearer to the eye.
class WireDrawing {
public:
    WireDrawing();
    ~WireDrawing();
    WireDrawing(const WireDrawing&) = delete;
    WireDrawing& operator=(const WireDrawing&) = delete;
};

}  // namespace sgm::render

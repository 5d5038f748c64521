#include "viewer/render/gpu.h"

#include <epoxy/gl.h>

namespace sgm::render {
namespace {

Error internal(std::string message) { return {Error::Kind::Internal, std::move(message)}; }

Result<uint32_t> compileStage(GLenum stage, const std::string& source) {
    const GLuint shader = glCreateShader(stage);
    const char* text = source.c_str();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    GLint good = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (good) return shader;
    char log[4096] = "";
    glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    glDeleteShader(shader);
    return internal(std::string("the driver refuses a shader: ") + log);
}

Result<Program> link(std::initializer_list<std::pair<GLenum, const std::string*>> stages) {
    Program program(glCreateProgram());
    for (const auto& [stage, source] : stages) {
        const Result<uint32_t> shader = compileStage(stage, *source);
        if (!shader) return shader.error();
        glAttachShader(program.id(), *shader);
        glDeleteShader(*shader);
    }
    glLinkProgram(program.id());
    GLint good = 0;
    glGetProgramiv(program.id(), GL_LINK_STATUS, &good);
    if (good) return program;
    char log[4096] = "";
    glGetProgramInfoLog(program.id(), sizeof log, nullptr, log);
    return internal(std::string("the driver can't link a shader: ") + log);
}

Renderbuffer makeRenderbuffer(GLenum format, int width, int height, int samples) {
    GLuint id = 0;
    glGenRenderbuffers(1, &id);
    glBindRenderbuffer(GL_RENDERBUFFER, id);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width, height);
    return Renderbuffer(id);
}

Framebuffer makeFramebuffer() {
    GLuint id = 0;
    glGenFramebuffers(1, &id);
    glBindFramebuffer(GL_FRAMEBUFFER, id);
    return Framebuffer(id);
}

/// Sampled linearly, its border repeated.
Texture makeTexture(GLenum format, int width, int height) {
    GLuint id = 0;
    glGenTextures(1, &id);
    glBindTexture(GL_TEXTURE_2D, id);
    glTexStorage2D(GL_TEXTURE_2D, 1, format, width, height);
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
        glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
    return Texture(id);
}

}  // namespace

namespace detail {
void freeProgram(uint32_t id) { glDeleteProgram(id); }
void freeBuffer(uint32_t id) { glDeleteBuffers(1, &id); }
void freeTexture(uint32_t id) { glDeleteTextures(1, &id); }
void freeFramebuffer(uint32_t id) { glDeleteFramebuffers(1, &id); }
void freeVertexArray(uint32_t id) { glDeleteVertexArrays(1, &id); }
void freeRenderbuffer(uint32_t id) { glDeleteRenderbuffers(1, &id); }
}  // namespace detail

Result<Program> Program::compute(const std::string& source) { return link({{GL_COMPUTE_SHADER, &source}}); }
Result<Program> Program::draw(const std::string& vertex, const std::string& fragment) {
    return link({{GL_VERTEX_SHADER, &vertex}, {GL_FRAGMENT_SHADER, &fragment}});
}
void Program::use() const { glUseProgram(id()); }
void Program::set(const char* name, float value) const {
    glProgramUniform1f(id(), glGetUniformLocation(id(), name), value);
}
void Program::set(const char* name, int value) const {
    glProgramUniform1i(id(), glGetUniformLocation(id(), name), value);
}
void Program::set(const char* name, uint32_t value) const {
    glProgramUniform1ui(id(), glGetUniformLocation(id(), name), value);
}
void Program::set(const char* name, Vec3f v) const {
    glProgramUniform3f(id(), glGetUniformLocation(id(), name), v.x, v.y, v.z);
}
void Program::set(const char* name, const Matrix4& matrix) const {
    glProgramUniformMatrix4fv(id(), glGetUniformLocation(id(), name), 1, GL_FALSE, matrix.data());
}

Buffer Buffer::ofBytes(const void* bytes, size_t size) {
    GLuint id = 0;
    glGenBuffers(1, &id);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, id);
    glBufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(size), bytes, GL_DYNAMIC_DRAW);
    return Buffer(id);
}
void Buffer::bindStorage(uint32_t binding) const { glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, id()); }
void Buffer::read(void* bytes, size_t size) const {
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, id());
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(size), bytes);
}

TexelBuffer TexelBuffer::of(std::span<const uint32_t> words, int wordsPerTexel) {
    TexelBuffer texels;
    texels.buffer_ = std::make_shared<const Buffer>(Buffer::of(words));
    return texels.as(wordsPerTexel);
}
TexelBuffer TexelBuffer::as(int wordsPerTexel) const {
    TexelBuffer texels;
    texels.buffer_ = buffer_;
    GLuint id = 0;
    glGenTextures(1, &id);
    texels.texture_ = Texture(id);
    glBindTexture(GL_TEXTURE_BUFFER, id);
    glTexBuffer(GL_TEXTURE_BUFFER, wordsPerTexel == 1 ? GL_R32UI : GL_RGBA32UI, texels.buffer_->id());
    return texels;
}
void TexelBuffer::bind(uint32_t unit) const {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_BUFFER, texture_.id());
}

namespace {

Texture makeVolume(GLenum stored, GLenum format, GLenum type, const void* values, Vec3i count,
                   VolumeTexture::Edge edge) {
    GLuint id = 0;
    glGenTextures(1, &id);
    glBindTexture(GL_TEXTURE_3D, id);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexStorage3D(GL_TEXTURE_3D, 1, stored, count.x, count.y, count.z);
    glTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, 0, count.x, count.y, count.z, format, type, values);
    const GLint filter = edge == VolumeTexture::Edge::Nearest ? GL_NEAREST : GL_LINEAR;
    const GLint wrap = edge == VolumeTexture::Edge::Repeat ? GL_REPEAT : GL_CLAMP_TO_EDGE;
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, filter);
    for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        glTexParameteri(GL_TEXTURE_3D, axis, wrap);
    return Texture(id);
}

}  // namespace

VolumeTexture VolumeTexture::of(std::span<const uint8_t> values, Vec3i count, Edge edge) {
    VolumeTexture made;
    made.texture_ = makeVolume(GL_R8, GL_RED, GL_UNSIGNED_BYTE, values.data(), count, edge);
    return made;
}
VolumeTexture VolumeTexture::of(std::span<const uint16_t> rgba, Vec3i count, Edge edge) {
    VolumeTexture made;
    made.texture_ = makeVolume(GL_RGBA16, GL_RGBA, GL_UNSIGNED_SHORT, rgba.data(), count, edge);
    return made;
}
void VolumeTexture::bind(uint32_t unit) const {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_3D, texture_.id());
}

void dispatch(size_t count) {
    glDispatchCompute(static_cast<GLuint>((count + 63) / 64), 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void finish() { glFinish(); }

Result<ColorTarget> ColorTarget::create(int width, int height, int samples) {
    GLint most = 1;
    glGetIntegerv(GL_MAX_SAMPLES, &most);
    samples = samples > 1 ? std::min(samples, most) : 0;
    ColorTarget target;
    target.width = width;
    target.height = height;
    target.color = makeRenderbuffer(GL_RGBA16F, width, height, samples);
    target.depth = makeRenderbuffer(GL_DEPTH_COMPONENT32F, width, height, samples);
    target.resolved = makeTexture(GL_RGBA16F, width, height);
    target.resolvedFramebuffer = makeFramebuffer();
    glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, target.resolved.id(), 0);
    target.framebuffer = makeFramebuffer();
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target.color.id());
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, target.depth.id());
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        return internal("the driver refuses a 16-bit float render target");
    return target;
}

void ColorTarget::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
    glViewport(0, 0, width, height);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void ColorTarget::resolve() const {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer.id());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolvedFramebuffer.id());
    glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

std::vector<float> ColorTarget::read() const {
    resolve();
    std::vector<float> pixels(size_t(width) * size_t(height) * 4);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, resolvedFramebuffer.id());
    glReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, pixels.data());
    return pixels;
}

void DisplayTexture::resize(int width, int height) {
    if (width == width_ && height == height_) return;
    width_ = width;
    height_ = height;
    texture_ = makeTexture(GL_RGBA8, width, height);
    framebuffer_ = makeFramebuffer();
    glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, texture_.id(), 0);
}
void DisplayTexture::write(std::span<const uint8_t> rgba, int x, int y, int width, int height) {
    glBindTexture(GL_TEXTURE_2D, texture_.id());
    glTexSubImage2D(GL_TEXTURE_2D, 0, x, y, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
}
void DisplayTexture::encode(const ColorTarget& target, const Program& encode) {
    resize(target.width, target.height);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    glViewport(0, 0, width_, height_);
    setDepthTest(false);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, target.resolved.id());
    encode.use();
    encode.set("light", 0);
    ScreenTriangle().draw();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}
std::vector<uint8_t> DisplayTexture::read() const {
    std::vector<uint8_t> bytes(size_t(width_) * size_t(height_) * 3);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.id());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE, bytes.data());
    return bytes;
}

MapStack MapStack::create(Kind kind, int edge, int layers) {
    MapStack maps;
    maps.kind = kind;
    maps.edge = edge;
    GLuint id = 0;
    glGenTextures(1, &id);
    maps.texture = Texture(id);
    glBindTexture(GL_TEXTURE_2D_ARRAY, id);
    glTexStorage3D(GL_TEXTURE_2D_ARRAY, 1, kind == Kind::Depth ? GL_DEPTH_COMPONENT32F : GL_R32F, edge, edge, layers);
    const GLint filter = kind == Kind::Depth ? GL_NEAREST : GL_LINEAR;
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return maps;
}

void MapStack::bindCleared(int layer) const {
    if (!framebuffer.id()) framebuffer = makeFramebuffer();
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
    glDrawBuffer(kind == Kind::Depth ? GL_NONE : GL_COLOR_ATTACHMENT0);
    glFramebufferTextureLayer(GL_FRAMEBUFFER, kind == Kind::Depth ? GL_DEPTH_ATTACHMENT : GL_COLOR_ATTACHMENT0,
                              texture.id(), 0, layer);
    glViewport(0, 0, edge, edge);
    glClear(kind == Kind::Depth ? GL_DEPTH_BUFFER_BIT : GL_COLOR_BUFFER_BIT);
}

void MapStack::bindTexture(uint32_t unit) const {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture.id());
}

PictureStack PictureStack::of(std::span<const std::vector<uint8_t>> pictures, int edge, bool colors) {
    const std::vector<uint8_t> black{0, 0, 0, 255};
    const std::vector<std::vector<uint8_t>> none{black};
    if (pictures.empty()) pictures = none, edge = 1;
    PictureStack stack;
    GLuint id = 0;
    glGenTextures(1, &id);
    stack.texture_ = Texture(id);
    glBindTexture(GL_TEXTURE_2D_ARRAY, id);
    const auto levels = static_cast<GLsizei>(std::bit_width(static_cast<uint32_t>(edge)));
    glTexStorage3D(GL_TEXTURE_2D_ARRAY, levels, colors ? GL_SRGB8_ALPHA8 : GL_RGBA8, edge, edge,
                   static_cast<GLsizei>(pictures.size()));
    for (size_t i = 0; i < pictures.size(); ++i)
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, static_cast<GLint>(i), edge, edge, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                        pictures[i].data());
    glGenerateMipmap(GL_TEXTURE_2D_ARRAY);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    return stack;
}

void PictureStack::bindTexture(uint32_t unit) const {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture_.id());
}

TriangleBuffers TriangleBuffers::of(std::span<const Vec3f> positions, std::span<const Vec3f> normals,
                                    std::span<const float> numbers, std::span<const Vec3<uint32_t>> triangles) {
    TriangleBuffers buffers;
    buffers.positions_ = Buffer::of(positions);
    buffers.normals_ = Buffer::of(normals);
    buffers.numbers_ = Buffer::of(numbers);
    buffers.indices_ = Buffer::of(triangles);
    return buffers;
}

TriangleBuffers TriangleBuffers::of(Buffer positions, Buffer normals, Buffer numbers, Buffer indices) {
    TriangleBuffers buffers;
    buffers.positions_ = std::move(positions);
    buffers.normals_ = std::move(normals);
    buffers.numbers_ = std::move(numbers);
    buffers.indices_ = std::move(indices);
    return buffers;
}

void TriangleBuffers::describe() const {
    GLuint id = 0;
    glGenVertexArrays(1, &id);
    array_ = VertexArray(id);
    glBindVertexArray(id);
    GLuint attribute = 0;
    for (const auto& [buffer, components] :
         {std::pair{&positions_, 3}, std::pair{&normals_, 3}, std::pair{&numbers_, 1}}) {
        glBindBuffer(GL_ARRAY_BUFFER, buffer->id());
        glVertexAttribPointer(attribute, components, GL_FLOAT, GL_FALSE, 0, nullptr);
        glEnableVertexAttribArray(attribute++);
    }
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.id());
}

void TriangleBuffers::draw(size_t first, size_t count) const {
    if (!array_.id()) describe();
    glBindVertexArray(array_.id());
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(count * 3), GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(first * 3 * sizeof(uint32_t)));
}

ScreenTriangle::ScreenTriangle() {
    GLuint id = 0;
    glGenVertexArrays(1, &id);
    array_ = VertexArray(id);
}
void ScreenTriangle::draw() const {
    glBindVertexArray(array_.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void setDepthTest(bool on) {
    on ? glEnable(GL_DEPTH_TEST) : glDisable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
}

WithoutColor::WithoutColor() { glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE); }
WithoutColor::~WithoutColor() { glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE); }

WireDrawing::WireDrawing() {
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    glEnable(GL_POLYGON_OFFSET_LINE);
    glPolygonOffset(-1, -1);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
}
WireDrawing::~WireDrawing() {
    glDisable(GL_BLEND);
    glDisable(GL_POLYGON_OFFSET_LINE);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

}  // namespace sgm::render

// The mesh by rasterisation, under the same light as the field. Drawn in batches of triangles, so that no draw takes
// long.
#include "viewer/render/mesh_scene.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "modeler/mesh/components.h"
#include "modeler/mesh/corners.h"
#include "viewer/render/mesh_marks.h"
#include "viewer/render/scene.h"
#include "viewer/render/shader_text.h"

namespace sgm::render {
namespace {

constexpr size_t batchTriangles = 1u << 17;  // a draw
constexpr float lineWidth = 1.6f;            // of hard edges, pixels
constexpr int seenEdge = 96;                 // pixels along the shorter side of the picture that tells what is seen

/// Four rows as a matrix by columns.
Matrix4 matrixOf(const std::array<std::array<double, 4>, 4>& rows) {
    Matrix4 matrix;
    for (size_t r = 0; r < 4; ++r)
        for (size_t c = 0; c < 4; ++c) matrix[c * 4 + r] = static_cast<float>(rows[r][c]);
    return matrix;
}

/// Clip space of one tile of the picture: x0, y0 its lower left pixel from the bottom left.
Matrix4 tileMatrix(const View& view, const PictureOptions& options, double near, double far, double x0, double y0,
                   int width, int height) {
    const double right2 = dot(view.right, view.right), up2 = dot(view.up, view.up);
    const Vec3d x = view.right / right2, y = view.up / up2, z = view.forward;
    // Picture coordinates −1 … 1 become the tile's by a scale and a shift, before the division by depth.
    const double sx = static_cast<double>(options.width) / width, sy = static_cast<double>(options.height) / height;
    const double tx = sx - 1 - 2.0 * x0 / width, ty = sy - 1 - 2.0 * y0 / height;
    const Vec3d cx = x * sx + z * tx, cy = y * sy + z * ty, cz = z * ((far + near) / (far - near));
    const auto row = [&](Vec3d a, double w) { return std::array<double, 4>{a.x, a.y, a.z, w - dot(a, view.eye)}; };
    return matrixOf({row(cx, 0), row(cy, 0), row(cz, -2 * far * near / (far - near)), row(z, 0)});
}

/// Mean over a vertex's edges of the normal curvature along them: (n_j − n_i)·(p_j − p_i) / |p_j − p_i|².
std::vector<float> curvaturesOf(const PreparedMesh& mesh) {
    std::vector<float> sums(mesh.positions.size(), 0.0f), counts(mesh.positions.size(), 0.0f);
    for (const Vec3<uint32_t>& t : mesh.triangles)
        for (int side = 0; side < 3; ++side) {
            const uint32_t a = t[side], b = t[(side + 1) % 3];
            const Vec3f along = mesh.positions[b] - mesh.positions[a];
            const float k = dot(mesh.normals[b] - mesh.normals[a], along) / std::max(dot(along, along), 1e-20f);
            for (const uint32_t v : {a, b}) {
                sums[v] += k;
                counts[v] += 1;
            }
        }
    for (size_t v = 0; v < sums.size(); ++v) sums[v] /= std::max(counts[v], 1.0f);
    return sums;
}

/// Numbers the connected components in the order of their first triangles.
void findComponents(PreparedMesh& mesh) {
    const mesh::SurfaceLabels surfaces = mesh::labelSurfaces(mesh.positions.size(), [&](auto f) {
        for (const Vec3<uint32_t>& t : mesh.triangles) f(t);
    });
    for (size_t i = 0; i < mesh.triangles.size(); ++i) mesh.owners[i].component = surfaces.of[mesh.triangles[i].x];
    mesh.components = surfaces.count;
}

/// Gives a vertex of its own to every normal that meets in one on a crease, after all others. Whose position a vertex
/// has says what hangs together, so components are found before.
void splitHardCorners(PreparedMesh& mesh, const mesh::CornerNormalTable& corners) {
    if (corners.empty()) return;
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> split;  // by vertex and normal
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const uint32_t own = corners.of[t][k];
            if (own == mesh::noIndex) continue;
            uint32_t& vertex = mesh.triangles[t][k];
            const auto [at, fresh] = split.try_emplace({vertex, own}, static_cast<uint32_t>(mesh.positions.size()));
            if (fresh) {
                mesh.positions.push_back(Vec3f(mesh.positions[vertex]));
                mesh.normals.push_back(corners.normals[own]);
            }
            vertex = at->second;
        }
}

/// By OriginId: the rule that made it, numbered in the order of the parts.
std::vector<uint32_t> rulesOf(const Provenance& provenance) {
    std::map<std::string, uint32_t> numbers;
    std::vector<uint32_t> rules;
    for (const Part& part : provenance.parts)
        rules.push_back(numbers.emplace(part.rule(), static_cast<uint32_t>(numbers.size())).first->second);
    return rules;
}

/// Material and rule of each triangle, by whose it is.
std::vector<PreparedMesh::Owner> ownersFrom(std::span<const OriginId> origins, const Provenance& provenance) {
    const std::vector<uint32_t> rules = rulesOf(provenance);
    std::vector<PreparedMesh::Owner> owners;
    for (const OriginId origin : origins) {
        const OriginId part = origin < provenance.parts.size() ? origin : 0;
        owners.push_back({provenance.parts[part].material, rules[part], 0, part});
    }
    return owners;
}

TexelBuffer upload(const std::vector<PreparedMesh::Owner>& owners) {
    std::vector<uint32_t> words;
    for (const PreparedMesh::Owner& owner : owners)
        words.insert(words.end(), {owner.material, owner.rule, owner.component, owner.piece});
    if (words.empty()) words.push_back(0);  // buffers hold something
    return TexelBuffer::of(words, 1);
}

}  // namespace

Result<PreparedMesh> prepareMesh(const mesh::Mesh& mesh, const Provenance& provenance) {
    PreparedMesh prepared;
    std::vector<OriginId> origins;
    for (const mesh::Chunk& chunk : mesh.chunks) {
        prepared.positions.insert(prepared.positions.end(), chunk.positions.begin(), chunk.positions.end());
        prepared.normals.insert(prepared.normals.end(), chunk.normals.begin(), chunk.normals.end());
        for (const mesh::Triangle& t : chunk.triangles) prepared.triangles.push_back(chunk.inMesh(t));
        origins.insert(origins.end(), chunk.origins.begin(), chunk.origins.end());
    }
    prepared.owners = ownersFrom(origins, provenance);
    if (prepared.normals.size() != prepared.positions.size() || prepared.owners.size() != prepared.triangles.size())
        return Error{Error::Kind::Internal, "the mesh has no normal for every vertex or no origin for every triangle"};
    prepared.bounds = mesh.bounds();
    prepared.materials = provenance.materials;
    auto textures = prepareMeshTextures(mesh, provenance);
    if (!textures) return textures.error();
    prepared.textures = std::move(*textures);
    findComponents(prepared);
    const auto neighbours = mesh::findEdgeNeighbours(prepared.triangles, prepared.positions.size());
    const std::vector<uint32_t> pieces = numberSmoothPieces(mesh, neighbours);
    for (size_t t = 0; t < pieces.size(); ++t) prepared.owners[t].piece = pieces[t];
    const mesh::CornerNormalTable corners = mesh::collectCornerNormals(mesh);
    prepared.hardEdges = findHardEdges(prepared.positions, prepared.triangles, neighbours, corners);
    splitHardCorners(prepared, corners);
    prepared.curvatures = curvaturesOf(prepared);
    return prepared;
}

Result<std::shared_ptr<const MeshPrograms>> MeshPrograms::create() {
    const auto programs = std::make_shared<MeshPrograms>();
    struct Wanted {
        Program& program;
        std::string_view vertex, fragment;
    };
    for (const Wanted& wanted :
         {Wanted{programs->depth, "mesh", "depth"}, Wanted{programs->mask, "screen", "mask"},
          Wanted{programs->position, "mesh", "position"}, Wanted{programs->blur, "screen", "blur_depth"},
          Wanted{programs->color, "mesh", "mesh_color"}, Wanted{programs->section, "mesh", "mesh_section"},
          Wanted{programs->backdrop, "screen", "backdrop"}, Wanted{programs->crease, "crease", "crease_color"}}) {
        Result<Program> made = Program::draw(shaderText(wanted.vertex), shaderText(wanted.fragment));
        if (!made) return made.error();
        wanted.program = std::move(*made);
    }
    return std::shared_ptr<const MeshPrograms>(programs);
}

MeshScene::MeshScene(const PreparedMesh& mesh, std::shared_ptr<const MeshPrograms> programs, SkyBudget sky)
    : programs_(std::move(programs)),
      bounds_(mesh.bounds),
      triangles_(TriangleBuffers::of(mesh.positions, mesh.normals, mesh.curvatures, mesh.triangles)),
      triangleCount_(mesh.triangles.size()),
      owners_(upload(mesh.owners)),
      hardEdges_(mesh.hardEdges),
      materials_(uploadMaterials(mesh.materials)),
      textured_(!mesh.textures.frames.empty()),
      light_(bounds_, skyMapsFor(triangleCount_, sky)) {
    if (!textured_) return;
    frameOfTriangle_ = TexelBuffer::of(mesh.textures.frameOfTriangle, 1);
    frames_ = Buffer::of<MeshTextures::Frame>(mesh.textures.frames);
    colorPictures_ = PictureStack::of(mesh.textures.colors, MeshTextures::edge, true);
    numberPictures_ = PictureStack::of(mesh.textures.numbers, MeshTextures::edge, false);
}

MeshScene::MeshScene(GpuTriangles triangles, std::span<const OriginId> owners, const Box3f& bounds,
                     const Provenance& provenance, std::shared_ptr<const MeshPrograms> programs)
    : programs_(std::move(programs)),
      bounds_(bounds),
      triangleCount_(triangles.count),
      owners_(upload(ownersFrom(owners, provenance))),
      materials_(uploadMaterials(provenance.materials)),
      light_(bounds_, leastSkyMaps) {
    const std::vector<float> flat(triangleCount_ * 3 + 1, 0.0f);
    triangles_ = TriangleBuffers::of(std::move(triangles.positions), std::move(triangles.normals),
                                     Buffer::of<float>(flat), std::move(triangles.indices));
}

/// All triangles, in batches.
Status MeshScene::drawTriangles(const Program& program, Progress* progress) const {
    program.use();
    for (size_t first = 0; first < triangleCount_; first += batchTriangles) {
        if (cancelled(progress)) return cancelledError();
        program.set("firstTriangle", static_cast<int>(first));
        triangles_.draw(first, std::min(batchTriangles, triangleCount_ - first));
        finish();
        tick(progress);
    }
    return Done{};
}

Status MeshScene::light(Progress* progress) {
    if (progress) progress->begin("light", (light_.skyCount() + 1) * (triangleCount_ / batchTriangles + 1));
    for (;;) {
        const Result<bool> all = lightMore(progress);
        if (!all) return all.error();
        if (*all) return Done{};
    }
}

Result<bool> MeshScene::lightMore(Progress* progress) {
    return light_.drawNext({programs_->depth, programs_->blur},
                           [&](const Program& program) { return drawTriangles(program, progress); });
}

Status MeshScene::lightFor(const PictureOptions& options, Progress* progress) {
    std::vector<Vec3f> seen;
    if (options.camera.lamp_m == 0) {
        auto found = seenFrom(options, progress);
        if (!found) return found.error();
        seen = std::move(*found);
    }
    return light_.fit(seen, options.camera.eye, {programs_->depth, programs_->blur},
                      [&](const Program& program) { return drawTriangles(program, progress); });
}

/// Places on the mesh, and on the ground about it, at pixels of a small picture.
Result<std::vector<Vec3f>> MeshScene::seenFrom(const PictureOptions& options, Progress* progress) const {
    PictureOptions small = options;
    const double scale = double(seenEdge) / std::min(options.width, options.height);
    small.width = static_cast<int>(std::ceil(scale * options.width));
    small.height = static_cast<int>(std::ceil(scale * options.height));
    const Result<ColorTarget> target = ColorTarget::create(small.width, small.height, 1);
    if (!target) return target.error();
    const View view = viewOf(small.camera, small.width, small.height);
    target->bind();
    setDepthTest(true);
    programs_->position.set("eye", view.eye.as<float>());
    programs_->position.set("clipFromWorld", clipOf(small, 0, 0, small.width, small.height));
    if (Status s = drawTriangles(programs_->position, progress); !s) return s.error();
    const std::vector<float> pixels = target->read();
    Box3f about = bounds_;  // where the mesh's shadow may lie
    about = hull(about, about.lo - Vec3f{1, 0, 1} * about.size().y);
    about = hull(about, about.hi + Vec3f{1, 0, 1} * about.size().y);
    std::vector<Vec3f> seen;
    for (int y = 0; y < small.height; ++y)
        for (int x = 0; x < small.width; ++x) {
            const float* pixel = &pixels[(size_t(y) * size_t(small.width) + size_t(x)) * 4];
            if (pixel[3] > 0) {
                seen.push_back(view.eye.as<float>() + Vec3f{pixel[0], pixel[1], pixel[2]});
                continue;
            }
            const Vec3f ray = rayThrough(view, small, {x + 0.5, small.height - y - 0.5});
            const float t = (bounds_.lo.y - static_cast<float>(view.eye.y)) / ray.y;
            Vec3f place = view.eye.as<float>() + ray * t;
            place.y = bounds_.lo.y;
            if (options.ground && t > 0 && std::isfinite(t) && about.contains(place)) seen.push_back(place);
        }
    return seen;
}

/// Clip space of a part of the picture whose lower left pixel is (left, low).
Matrix4 MeshScene::clipOf(const PictureOptions& options, double left, double low, int width, int height) const {
    const View view = viewOf(options.camera, options.width, options.height);
    const double size = length(bounds_.size().as<double>()), away = length(bounds_.centre().as<double>() - view.eye);
    const double near = nearest(view), far = near + 2 * size + away;
    return tileMatrix(view, options, near, far, left, low, width, height);
}

/// The least depth at which something is drawn, metres: that of the nearest corner of the bounds.
double MeshScene::nearest(const View& view) const {
    const Vec3d half = bounds_.size().as<double>() / 2, centre = bounds_.centre().as<double>();
    const Vec3d& ahead = view.forward;
    const double reach = std::abs(ahead.x) * half.x + std::abs(ahead.y) * half.y + std::abs(ahead.z) * half.z;
    return std::max(dot(ahead, centre - view.eye) - reach, 2e-3 * length(half));
}

void MeshScene::bindTextures(const Program& program) const {
    program.set("textured", textured_ ? 1 : 0);
    program.set("frameOfTriangle", 3);
    program.set("colorPictures", 4);
    program.set("numberPictures", 5);
    if (!textured_) return;
    frameOfTriangle_.bind(3);
    frames_.bindStorage(5);
    colorPictures_.bindTexture(4);
    numberPictures_.bindTexture(5);
}

void MeshScene::drawMask(const Subsample& subsample, int columns) const {
    if (!subsample.wanted) return;
    const WithoutColor depthAlone;
    const Program& mask = programs_->mask;
    subsample.wanted->bind(0);
    mask.set("wanted", 0);
    mask.set("columns", columns);
    mask.use();
    ScreenTriangle().draw();
}

Status MeshScene::draw(const ColorTarget& target, int x0, int y0, const PictureOptions& options, const MeshStyle& style,
                       Progress* progress, const Subsample& subsample) const {
    const View view = viewOf(options.camera, options.width, options.height);
    const Program &color = style.section ? programs_->section : programs_->color, &backdrop = programs_->backdrop;
    for (const Program* program : {&color, &backdrop}) {
        setScene(*program, bounds_, options);
        program->set("ownerOfTriangle", 0);
        light_.bind(*program, options.camera.lamp_m == 0);  // inside a hollow no sky is seen: the lamp does it alone
    }
    target.bind();
    setDepthTest(true);
    drawMask(subsample, target.width);
    owners_.bind(0);
    materials_.bindStorage(4);
    bindTextures(color);
    const double left = x0 + subsample.right, low = y0 - subsample.down;
    const Matrix4 clipFromWorld = clipOf(options, left, low, target.width, target.height);
    if (!style.section && !subsample.wanted) {  // depth first, for shading what is hidden costs as much as what is seen
        const WithoutColor depthAlone;
        programs_->depth.set("clipFromWorld", clipFromWorld);
        if (Status s = drawTriangles(programs_->depth, progress); !s) return s;
    }
    color.set("clipFromWorld", clipFromWorld);
    color.set("meshLook", static_cast<int>(style.look));
    if (style.section) {
        color.set("sectionNormal", style.section->normal);
        color.set("sectionOffset", style.section->offset);
    }
    color.set("wire", 0);
    if (Status s = drawTriangles(color, progress); !s) return s;
    backdrop.use();  // where nothing was drawn
    backdrop.set("tileCorner", Vec3f{static_cast<float>(left), static_cast<float>(low), 0});
    ScreenTriangle().draw();
    if (style.wireframe) {
        color.set("wire", 1);
        const WireDrawing wires;
        if (Status s = drawTriangles(color, progress); !s) return s;
    }
    if (style.look != MeshLook::Creases) return Done{};
    return drawCreases({clipFromWorld, view.eye.as<float>(), static_cast<float>(nearest(view))}, target, style,
                       progress);
}

Status MeshScene::drawCreases(const Projection& from, const ColorTarget& target, const MeshStyle& style,
                              Progress* progress) const {
    const Program& crease = programs_->crease;
    crease.set("clipFromWorld", from.clipFromWorld);
    crease.set("eyeAt", from.eye);
    crease.set("nearest", from.near);
    crease.set("targetSize", Vec3f{static_cast<float>(target.width), static_cast<float>(target.height), 1});
    crease.set("lineWidth", lineWidth);
    crease.set("sectionNormal", style.section ? style.section->normal : Vec3f{});
    crease.set("sectionOffset", style.section ? style.section->offset : 0.0f);
    return hardEdges_.draw(crease, progress);
}

}  // namespace sgm::render

// The mesh by rasterisation, under the same light as the field: soft sun shadow from one depth map, sky visibility from
// many (a depth map a direction). Drawn tile by tile and in batches of triangles, so that no draw takes long.
#include <cmath>

#include "viewer/gpu.h"
#include "viewer/scene.h"
#include "viewer/shader_text.h"

namespace sgm::viewer {
namespace {

constexpr int tileEdge = 1024;               // pixels
constexpr size_t batchTriangles = 1u << 17;  // a draw
constexpr int sunMapEdge = 2048, skyMapEdge = 256;
constexpr size_t mostSkyMaps = 40;  // as in visibility.glsl

/// The mesh on the GPU and the programs that draw it.
struct MeshPicture {
    TriangleBuffers triangles;
    size_t triangleCount;
    TexelBuffer materialOfTriangle;
    Buffer materials;
    Program depth, blur, color, backdrop;
    MapStack sunMap, skyMaps;
};

/// Four rows as a matrix by columns.
Matrix4 matrixOf(const std::array<std::array<double, 4>, 4>& rows) {
    Matrix4 matrix;
    for (size_t r = 0; r < 4; ++r)
        for (size_t c = 0; c < 4; ++c) matrix[c * 4 + r] = static_cast<float>(rows[r][c]);
    return matrix;
}

/// Looks along −`towardsLight` at a ball of diameter `span`: all of it maps to lo … hi in the three components.
Matrix4 lightMatrix(Vec3d towardsLight, Vec3d centre, double span, double lo, double hi) {
    const Vec3d right =
        normalized(cross(std::abs(towardsLight.y) > 0.99 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0}, towardsLight));
    const Vec3d up = cross(towardsLight, right);
    const double scale = (hi - lo) / span, middle = (hi + lo) / 2;
    const auto row = [&](Vec3d axis) {
        const Vec3d a = axis * scale;
        return std::array<double, 4>{a.x, a.y, a.z, middle - dot(a, centre)};
    };
    return matrixOf({row(right), row(up), row(-towardsLight), {0, 0, 0, 1}});
}

/// Directions spread evenly over the sphere (Fibonacci's lattice).
Vec3d skyDirection(size_t i, size_t count) {
    const double y = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count), r = std::sqrt(1 - y * y);
    const double angle = static_cast<double>(i) * 2.39996322972865332;
    return {r * std::cos(angle), y, r * std::sin(angle)};
}

/// Clip space of one tile of the picture: x0, y0 its lower left pixel from the bottom left.
Matrix4 tileMatrix(const View& view, const PictureOptions& options, double near, double far, int x0, int y0, int width,
                   int height) {
    const double right2 = dot(view.right, view.right), up2 = dot(view.up, view.up);
    const Vec3d x = view.right / right2, y = view.up / up2, z = view.forward;
    // Picture coordinates −1 … 1 become the tile's by a scale and a shift, before the division by depth.
    const double sx = static_cast<double>(options.width) / width, sy = static_cast<double>(options.height) / height;
    const double tx = sx - 1 - 2.0 * x0 / width, ty = sy - 1 - 2.0 * y0 / height;
    const Vec3d cx = x * sx + z * tx, cy = y * sy + z * ty, cz = z * ((far + near) / (far - near));
    const auto row = [&](Vec3d a, double w) { return std::array<double, 4>{a.x, a.y, a.z, w - dot(a, view.eye)}; };
    return matrixOf({row(cx, 0), row(cy, 0), row(cz, -2 * far * near / (far - near)), row(z, 0)});
}

/// All triangles, in batches.
Status drawTriangles(const MeshPicture& picture, const Program& program, Progress* progress) {
    program.use();
    for (size_t first = 0; first < picture.triangleCount; first += batchTriangles) {
        if (cancelled(progress)) return Error{Error::Kind::Cancelled, "cancelled"};
        program.set("firstTriangle", static_cast<int>(first));
        picture.triangles.draw(first, std::min(batchTriangles, picture.triangleCount - first));
        finish();
        if (progress) progress->tick();
    }
    return Done{};
}

Result<MeshPicture> upload(const mesh::Mesh& mesh, const Provenance& provenance) {
    std::vector<Vec3f> positions, normals;
    std::vector<mesh::Triangle> triangles;
    std::vector<uint32_t> materials;
    for (const mesh::Chunk& chunk : mesh.chunks) {
        positions.insert(positions.end(), chunk.positions.begin(), chunk.positions.end());
        normals.insert(normals.end(), chunk.normals.begin(), chunk.normals.end());
        for (const mesh::Triangle& t : chunk.triangles) triangles.push_back(chunk.inMesh(t));
        for (const OriginId origin : chunk.origins)
            materials.push_back(provenance.parts[origin < provenance.parts.size() ? origin : 0].material);
    }
    if (normals.size() != positions.size() || materials.size() != triangles.size())
        return Error{Error::Kind::Internal, "the mesh has no normal for every vertex or no origin for every triangle"};
    MeshPicture picture;
    picture.triangles = TriangleBuffers::of(positions, normals, triangles);
    picture.triangleCount = triangles.size();
    picture.materialOfTriangle = TexelBuffer::of(materials, 1);
    picture.materials = uploadMaterials(provenance.materials);
    struct Wanted {
        Program& program;
        std::string_view vertex, fragment;
    };
    for (const Wanted& wanted :
         {Wanted{picture.depth, "mesh", "depth"}, Wanted{picture.blur, "screen", "blur_depth"},
          Wanted{picture.color, "mesh", "mesh_color"}, Wanted{picture.backdrop, "screen", "backdrop"}}) {
        Result<Program> made = Program::draw(shaderText(wanted.vertex), shaderText(wanted.fragment));
        if (!made) return made.error();
        wanted.program = std::move(*made);
    }
    return picture;
}

/// Draws the depth maps and hands their matrices to the programs that read them.
Status drawMaps(MeshPicture& picture, const Box3f& bounds, const PictureOptions& options, Progress* progress) {
    const Vec3d centre = bounds.centre().as<double>(), sun = sunDirection().as<double>();
    const double span = 1.02 * length(bounds.size().as<double>());
    // Inside a hollow no sky is seen: the lamp does it alone.
    const bool lamp = options.camera.lamp_m > 0;
    const size_t skyCount =
        lamp ? 0 : std::clamp<size_t>((size_t(24) << 20) / std::max<size_t>(picture.triangleCount, 1), 12, mostSkyMaps);
    picture.sunMap = MapStack::create(MapStack::Kind::Depth, sunMapEdge, 1);
    picture.skyMaps = MapStack::create(MapStack::Kind::Number, skyMapEdge, std::max(1, static_cast<int>(skyCount)));
    const MapStack skyDepth = MapStack::create(MapStack::Kind::Depth, skyMapEdge, 1);
    const auto drawMap = [&](const MapStack& map, Vec3d towardsLight) {
        setDepthTest(true);
        map.bindCleared(0);
        picture.depth.set("clipFromWorld", lightMatrix(towardsLight, centre, span, -1, 1));
        return drawTriangles(picture, picture.depth, progress);
    };
    if (Status s = drawMap(picture.sunMap, sun); !s) return s;
    const ScreenTriangle screen;
    std::vector<Matrix4> matrices(mostSkyMaps, Matrix4{});
    for (size_t i = 0; i < skyCount; ++i) {
        if (Status s = drawMap(skyDepth, skyDirection(i, skyCount)); !s) return s;
        setDepthTest(false);
        picture.skyMaps.bindCleared(static_cast<int>(i));
        skyDepth.bindTexture(0);
        picture.blur.use();
        screen.draw();
        matrices[i] = lightMatrix(skyDirection(i, skyCount), centre, span, 0, 1);
    }
    for (const Program* program : {&picture.color, &picture.backdrop}) {
        setScene(*program, bounds, options);
        program->set("materialOfTriangle", 0);
        program->set("sunMap", 1);
        program->set("skyMaps", 2);
        program->set("sunFromWorld", lightMatrix(sun, centre, span, 0, 1));
        program->set("skyFromWorld", std::span<const Matrix4>(matrices));
        program->set("skyCount", static_cast<int>(skyCount));
        program->set("mapSpan", static_cast<float>(span));
    }
    return Done{};
}

/// One tile, RGBA, bottom row first.
Result<std::vector<float>> drawTile(const MeshPicture& picture, const ColorTarget& target, int x0, int y0,
                                    const Matrix4& clip, Progress* progress) {
    target.bind();
    setDepthTest(false);
    picture.backdrop.use();
    picture.backdrop.set("tileCorner", Vec3f{static_cast<float>(x0), static_cast<float>(y0), 0});
    ScreenTriangle().draw();
    setDepthTest(true);
    picture.color.set("clipFromWorld", clip);
    if (Status s = drawTriangles(picture, picture.color, progress); !s) return s.error();
    return target.read();
}

}  // namespace

Result<Image> drawMesh(const mesh::Mesh& mesh, const Provenance& provenance, const PictureOptions& options,
                       Progress* progress) {
    const Box3f bounds = mesh.bounds();
    if (Status status = checkPicture(bounds, options); !status) return status.error();
    const Result<GpuContext> gpu = GpuContext::create();
    if (!gpu) return gpu.error();
    Result<MeshPicture> picture = upload(mesh, provenance);
    if (!picture) return picture.error();
    if (progress) progress->begin("draw", (mostSkyMaps + 2) * (picture->triangleCount / batchTriangles + 1));
    if (Status status = drawMaps(*picture, bounds, options, progress); !status) return status.error();
    picture->materialOfTriangle.bind(0);
    picture->sunMap.bindTexture(1);
    picture->skyMaps.bindTexture(2);
    picture->materials.bindStorage(4);

    const View view = viewOf(options.camera, options.width, options.height);
    const double size = length(bounds.size().as<double>());
    const double near = std::max(length(bounds.centre().as<double>() - view.eye) - size / 2, 1e-3 * size),
                 far = near + 2 * size + length(bounds.centre().as<double>() - view.eye);
    std::vector<float> pixels(size_t(options.width) * size_t(options.height) * 4);
    for (int y0 = 0; y0 < options.height; y0 += tileEdge)
        for (int x0 = 0; x0 < options.width; x0 += tileEdge) {
            const int width = std::min(tileEdge, options.width - x0), height = std::min(tileEdge, options.height - y0);
            const Result<ColorTarget> target = ColorTarget::create(width, height, options.samples);
            if (!target) return target.error();
            const Result<std::vector<float>> tile = drawTile(
                *picture, *target, x0, y0, tileMatrix(view, options, near, far, x0, y0, width, height), progress);
            if (!tile) return tile.error();
            for (int y = 0; y < height; ++y) {
                const size_t row = size_t(options.height - 1 - (y0 + y)) * size_t(options.width) + size_t(x0);
                std::copy_n(tile->begin() + std::ptrdiff_t(size_t(y) * size_t(width) * 4), size_t(width) * 4,
                            pixels.begin() + std::ptrdiff_t(row * 4));
            }
        }
    return encode(pixels, options.width, options.height);
}

}  // namespace sgm::viewer

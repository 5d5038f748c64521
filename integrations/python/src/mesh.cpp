// Meshes as arrays, what they are made of, and files of them.
#include <pybind11/stl.h>

#include <algorithm>
#include <cstring>

#include "grammar/pipeline/grids.h"
#include "grammar/pipeline/products.h"
#include "integrations/python/src/call.h"
#include "integrations/python/src/objects.h"
#include "modeler/core/parallel.h"
#include "modeler/mesh/connected_components.h"
#include "modeler/mesh/corners.h"
#include "modeler/mesh/validate.h"

namespace py = pybind11;

namespace sgm::python {
namespace {

/// Rows of three numbers that `owner` keeps, not to be written to.
template <class Number, class Row>
py::array rowsOf(const Row* rows, size_t count, const py::handle& owner) {
    static_assert(sizeof(Row) == 3 * sizeof(Number));
    const std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(count), 3}, strides{sizeof(Row), sizeof(Number)};
    py::array array(py::dtype::of<Number>(), shape, strides, rows, owner);
    array.attr("setflags")(py::arg("write") = false);
    return array;
}

py::array positionsOf(const py::object& self) {
    const auto mesh = self.cast<std::shared_ptr<Mesh>>();
    const auto& list = mesh->isOneChunk() ? mesh->chunks.chunks[0].positions : mesh->positions;
    return rowsOf<float>(list.data(), list.size(), self);
}

py::array normalsOf(const py::object& self) {
    const auto mesh = self.cast<std::shared_ptr<Mesh>>();
    const auto& list = mesh->isOneChunk() ? mesh->chunks.chunks[0].normals : mesh->normals;
    return rowsOf<float>(list.data(), list.size(), self);
}

py::array trianglesOf(const py::object& self) {
    const auto mesh = self.cast<std::shared_ptr<Mesh>>();
    const auto& list = mesh->isOneChunk() ? mesh->chunks.chunks[0].triangles : mesh->triangles;
    return rowsOf<uint32_t>(list.data(), list.size(), self);
}

py::array originsOf(const py::object& self) {
    const auto mesh = self.cast<std::shared_ptr<Mesh>>();
    const auto& list = mesh->isOneChunk() ? mesh->chunks.chunks[0].origins : mesh->origins;
    py::array array(py::dtype::of<OriginId>(), {static_cast<py::ssize_t>(list.size())},
                    {static_cast<py::ssize_t>(sizeof(OriginId))}, list.data(), self);
    array.attr("setflags")(py::arg("write") = false);
    return array;
}

/// The normal at each corner of each triangle: its own where it has one, else its vertex's.
PageVector<Vec3f> normalsByCorner(const Mesh& mesh) {
    PageVector<Vec3f> found(3 * mesh.chunks.triangleCount());
    const auto& normals = mesh.isOneChunk() ? mesh.chunks.chunks[0].normals : mesh.normals;
    size_t first = 0;
    for (const mesh::Chunk& chunk : mesh.chunks.chunks) {
        for (size_t t = 0; t < chunk.triangles.size(); ++t)
            for (int corner = 0; corner < 3; ++corner)
                found[3 * (first + t) + static_cast<size_t>(corner)] =
                    normals[chunk.inMesh(chunk.triangles[t][corner])];
        for (const mesh::CornerNormal& own : chunk.cornerNormals) found[3 * first + own.corner] = own.normal;
        first += chunk.triangles.size();
    }
    return found;
}

py::array cornerNormalsOf(const py::object& self) {
    const auto mesh = self.cast<std::shared_ptr<Mesh>>();
    if (mesh->cornerNormals.empty()) {
        auto found = [&] {
            const py::gil_scoped_release withoutLock;
            return normalsByCorner(*mesh);
        }();
        // Another thread may have found them meanwhile, and arrays may show them: those stay.
        if (mesh->cornerNormals.empty()) mesh->cornerNormals = std::move(found);
    }
    const std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(mesh->cornerNormals.size() / 3), 3, 3};
    py::array array(py::dtype::of<float>(), shape, {36, 12, 4}, mesh->cornerNormals.data(), self);
    array.attr("setflags")(py::arg("write") = false);
    return array;
}

py::list partsOf(const Mesh& mesh) {
    py::list parts;
    for (const Part& p : mesh.provenance->parts)
        parts.append(py::make_tuple(p.path.text(), p.symbol(), p.rule(), p.file(), p.line(), p.material));
    return parts;
}

py::list materialsOf(const Mesh& mesh) {
    py::list materials;
    for (const Material& m : mesh.provenance->materials)
        materials.append(
            py::make_tuple(m.name, py::make_tuple(m.color.x, m.color.y, m.color.z), m.roughness, m.metallic));
    return materials;
}

py::dict figuresOf(const Mesh& mesh) {
    mesh::MeshFigures f;
    std::vector<mesh::ConnectedComponent> solids;
    {
        const py::gil_scoped_release withoutLock;
        f = mesh::measure(mesh.chunks);
        solids = mesh::connectedComponents(mesh.chunks, mesh.grid.cell_m, mesh.threads);
    }
    using namespace py::literals;
    const auto floating = std::count_if(solids.begin(), solids.end(), [](const auto& s) { return s.floats; });
    return py::dict("vertices"_a = f.vertices, "triangles"_a = f.triangles, "components"_a = f.components,
                    "cavities"_a = f.cavities, "boundary_edges"_a = f.boundaryEdges,
                    "nonmanifold_edges"_a = f.nonmanifoldEdges, "euler"_a = f.euler, "volume_m3"_a = f.volume_m3,
                    "area_m2"_a = f.area_m2, "bounds"_a = tupleOf(f.bounds), "floating"_a = floating);
}

py::dict fieldFiguresOf(const Mesh& mesh) {
    using namespace py::literals;
    const mesh::Counts& c = mesh.counts;
    return py::dict("instructions"_a = mesh.model ? mesh.model->tape.size() : 0,
                    "point_evaluations"_a = c.pointEvaluations, "refinement_evaluations"_a = c.refinementEvaluations,
                    "interval_evaluations"_a = c.intervalEvaluations, "surface_cells"_a = c.surfaceCells);
}

/// What makes a file of the mesh, beside its name.
struct FileRequest {
    std::string path, objects, collider;
    int levels = 1;
    exporter::ExportOptions options;
};

/// An object of a scene by itself.
Status writeObject(const Mesh& mesh, const FileRequest& request, const exporter::Exporter& row,
                   pipeline::Context& context) {
    if (row.wantsSolids || row.wantsPlan || !request.objects.empty() || !request.collider.empty() || request.levels > 1)
        return Error{Error::Kind::Usage,
                     "an object of a scene is saved as a mesh alone, without objects, collider and levels"};
    exporter::ExportInput input;
    input.mesh = &mesh.chunks;
    input.provenance = mesh.provenance.get();
    input.name = mesh.name;
    input.options = request.options;
    input.progress = context.progress;
    return context.timed("write", [&] { return exporter::write(input, request.path); });
}

Status writeFile(const Mesh& mesh, const FileRequest& request, const exporter::Exporter& row,
                 pipeline::Context& context) {
    if (!mesh.model) return writeObject(mesh, request, row, context);
    const pipeline::Model& model = *mesh.model;
    auto division = pipeline::divide(model, request.objects);
    if (!division.ok()) return division.error();
    pipeline::ProductRequest wanted{std::move(*division), request.collider, request.levels, false, false,
                                    mesh.edits,           mesh.meshing};
    const pipeline::MeshedModel meshed{mesh.grid, {}, {}, mesh.counts};
    const auto products = pipeline::makeProducts(model, meshed, mesh.chunks, std::move(wanted), context);
    if (!products.ok()) return products.error();
    exporter::ExportInput input = pipeline::exportInput(model, model.derivation.grammar->sources[0]->name());
    products->applyTo(input);
    field::SolidTree solids;
    if (row.wantsSolids) {
        auto tree = pipeline::makeSolidTree(model, context);
        if (!tree.ok()) return tree.error();
        solids = std::move(*tree);
        input.solids = &solids;
    }
    input.plan = &model.derivation.plan;
    input.options = request.options;
    input.progress = context.progress;
    return context.timed("write", [&] { return exporter::write(input, request.path); });
}

void save(Mesh& mesh, const FileRequest& request, const py::object& progress) {
    const exporter::Exporter* const row = exporter::exporterFor(request.path);
    if (row && row->wantsVolume)
        raise(Error{Error::Kind::Usage, "'" + request.path + "' holds a volume: Model.level_set(…).save writes it"});
    if (!row) raise(Error{Error::Kind::Usage, "no format has the ending of '" + request.path + "'"});
    pipeline::Stages stages;
    staged<Done>(progress, mesh.threads, stages,
                 [&](auto& context) { return writeFile(mesh, request, *row, context); });
}

}  // namespace

bool Mesh::isOneChunk() const {
    return chunks.chunks.size() == 1 && chunks.chunks[0].firstVertex == 0 && chunks.chunks[0].ghosts.vertices.empty();
}

void Mesh::flatten() {
    if (isOneChunk()) return;
    const std::vector<mesh::Chunk>& all = chunks.chunks;
    std::vector<size_t> firstTriangle(all.size() + 1, 0);
    for (size_t i = 0; i < all.size(); ++i) firstTriangle[i + 1] = firstTriangle[i] + all[i].triangles.size();
    positions.resize(chunks.vertexCount());
    normals.resize(positions.size());
    triangles.resize(firstTriangle.back());
    origins.resize(triangles.size());
    parallelFor(all.size(), threads, nullptr, [&](size_t i, int) {
        const mesh::Chunk& chunk = all[i];
        std::copy(chunk.positions.begin(), chunk.positions.end(), positions.begin() + chunk.firstVertex);
        std::copy(chunk.normals.begin(), chunk.normals.end(), normals.begin() + chunk.firstVertex);
        mesh::Triangle* const to = triangles.data() + firstTriangle[i];
        for (size_t t = 0; t < chunk.triangles.size(); ++t) to[t] = chunk.inMesh(chunk.triangles[t]);
        std::copy(chunk.origins.begin(), chunk.origins.end(),
                  origins.begin() + static_cast<std::ptrdiff_t>(firstTriangle[i]));
    });
}

Result<std::shared_ptr<Mesh>> finish(std::shared_ptr<const pipeline::Model> model, pipeline::MeshedModel meshed,
                                     const MeshRequest& request, pipeline::Context& context) {
    const float cell_m = meshed.grid.cell_m;
    mesh::keepOnly(meshed.mesh, request.edits.keep, cell_m, context.threads);
    auto edited =
        pipeline::edited(std::move(meshed.mesh), request.edits, {model->tape, request.surface, cell_m}, context);
    if (!edited.ok()) return edited.error();
    if (edited->triangleCount() == 0) return pipeline::noSurface(*model, cell_m);
    auto made = std::make_shared<Mesh>();
    made->provenance = {model, &model->lowered->provenance};
    made->model = std::move(model);
    made->chunks = std::move(*edited);
    made->grid = meshed.grid;
    made->counts = meshed.counts;
    made->meshing.surface = request.surface;
    made->edits = request.edits;
    made->threads = context.threads;
    context.timed("arrays", [&] { return made->flatten(), Done{}; });
    return made;
}

MeshRequest requestOf(int resolution, std::optional<double> cell_m, const std::string& surface, const std::string& keep,
                      int smooth, double simplify, std::optional<double> tolerance_m) {
    const auto check = [](bool fine, const char* message) {
        if (!fine) throw py::value_error(message);
    };
    check(resolution >= 2 && resolution <= pipeline::mostResolution, "resolution is from 2 to 8192 cells");
    check(!cell_m || (*cell_m >= 1e-6 && *cell_m <= 1e6), "cell is from 1e-6 to 1e6 metres");
    check(surface == "crisp" || surface == "cubes", "surface is 'crisp' or 'cubes'");
    check(keep == "all" || keep == "grounded" || keep == "largest", "keep is 'all', 'grounded' or 'largest'");
    check(smooth >= 0 && smooth <= 1000, "smooth is from 0 to 1000 passes");
    check(simplify >= .001 && simplify <= 1, "simplify is a share of the triangles, from .001 to 1");
    check(!tolerance_m || (*tolerance_m >= 0 && *tolerance_m <= 1e6), "tolerance is from 0 to 1e6 metres");
    check(!tolerance_m || simplify == 1, "say either simplify or tolerance");
    MeshRequest request{resolution, cell_m.value_or(0), mesh::Surface::Crisp, {}};
    if (surface == "cubes") request.surface = mesh::Surface::Cubes;
    request.edits.keep = keep == "all"        ? mesh::Keep::All
                         : keep == "grounded" ? mesh::Keep::Grounded
                                              : mesh::Keep::Largest;
    request.edits.smooth = smooth;
    request.edits.simplify = simplify;
    request.edits.tolerance_m = tolerance_m;
    return request;
}

void bindMesh(py::module_& module) {
    py::class_<MeshRequest>(module, "MeshRequest", "How a mesh is made.")
        .def(py::init(&requestOf), py::arg("resolution"), py::arg("cell"), py::arg("surface"), py::arg("keep"),
             py::arg("smooth"), py::arg("simplify"), py::arg("tolerance"));
    py::class_<Mesh, std::shared_ptr<Mesh>>(module, "Mesh", "A closed mesh of triangles.")
        .def_property_readonly("positions", &positionsOf)
        .def_property_readonly("normals", &normalsOf)
        .def_property_readonly("triangles", &trianglesOf)
        .def_property_readonly("origins", &originsOf)
        .def_property_readonly("corner_normals", &cornerNormalsOf)
        .def_property_readonly("parts", &partsOf)
        .def_property_readonly("materials", &materialsOf)
        .def_property_readonly("cell", [](const Mesh& m) { return m.grid.cell_m; })
        .def_property_readonly("stages", [](const Mesh& m) { return dictOf(m.stages); })
        .def_property_readonly("figures", &figuresOf)
        .def_property_readonly("field_figures", &fieldFiguresOf)
        .def(
            "save",
            [](Mesh& mesh, const std::string& path, const std::string& objects, const std::string& collider, int levels,
               const std::map<std::string, std::string>& options, const py::object& progress) {
                save(mesh, {path, objects, collider, levels, {options.begin(), options.end()}}, progress);
            },
            py::arg("path"), py::arg("objects"), py::arg("collider"), py::arg("levels"), py::arg("options"),
            py::arg("progress"));
}

}  // namespace sgm::python

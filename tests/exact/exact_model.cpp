#include "tests/exact/exact_model.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "modeler/core/random.h"

namespace sgm::exact {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* script = "tests/exact/exact.mjs";
constexpr const char* scripts[] = {script, "tests/exact/features.mjs", "tests/exact/solids.mjs"};

std::string contentOf(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

/// The exit code of a command of the shell, 127 where there is no such program.
int run(const std::string& command) {
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

Vec3d vecOf(const json& row, size_t at) {
    return {row[at].get<double>(), row[at + 1].get<double>(), row[at + 2].get<double>()};
}

Segment segmentOf(const json& row) { return {vecOf(row, 0), vecOf(row, 3)}; }

Crease creaseOf(const json& row) {
    return {segmentOf(row), row[6], row[7], row[8].get<int>() != 0, {vecOf(row, 9), vecOf(row, 12)}};
}

template <class T>
void readList(std::istream& file, std::vector<T>& list, size_t count) {
    list.resize(count);
    file.read(reinterpret_cast<char*>(list.data()), static_cast<std::streamsize>(count * sizeof(T)));
}

/// The file that exact.mjs calls MESH.bin.
bool readMesh(const fs::path& path, ExactModel& model) {
    std::ifstream file(path, std::ios::binary);
    std::vector<uint32_t> head;
    readList(file, head, 2);
    readList(file, model.points, head[0]);
    readList(file, model.normals, head[1]);
    readList(file, model.triangles, head[1]);
    readList(file, model.origins, head[1]);
    readList(file, model.round, head[1]);
    return bool(file);
}

void readFeatures(const fs::path& path, ExactModel& model) {
    const json all = json::parse(contentOf(path));
    model.sides = all["sides"];
    model.volume_m3 = all["volume_m3"];
    model.area_m2 = all["area_m2"];
    model.crease_m = all["crease_m"];
    model.euler = all["euler"];
    for (const json& row : all["creases"]) model.creases.push_back(creaseOf(row));
    for (const json& row : all["corners"]) model.corners.push_back({vecOf(row, 0), row[3], row[4]});
}

}  // namespace

std::string missingJudge() {
    const int code = run(std::string("node ") + script + " --check > /dev/null 2>&1");
    if (code == 0) return "";
    return code == 127 ? "node isn't installed" : "manifold-3d isn't installed: npm install --prefix build manifold-3d";
}

Result<ExactModel> exactModel(const fs::path& csgJson, int sides, Owners owners, const fs::path& folder) {
    std::string content = contentOf(csgJson) + (owners == Owners::First ? " first " : " ") + std::to_string(sides);
    for (const char* part : scripts) content += contentOf(part);
    const uint64_t key = hashText(content);
    std::error_code ignored;
    fs::create_directories(folder, ignored);
    const std::string base =
        (folder / fmt::format("{}-{}-{:016x}", csgJson.stem().stem().string(), sides, key)).string();
    const std::string features = base + ".json", mesh = base + ".bin", log = base + ".log";
    if (!fs::exists(features)) {
        // The features come last, so that a run which was cut off leaves none.
        const int code = run(fmt::format(
            "node --max-old-space-size=8192 {} '{}' --sides {}{} --mesh '{}' -o '{}.part' 2> '{}' && mv '{}.part' '{}'",
            script, csgJson.string(), sides, owners == Owners::First ? " --owners" : "", mesh, features, log, features,
            features));
        if (code != 0) return Error{Error::Kind::Input, contentOf(log)};
    }
    ExactModel model;
    try {
        readFeatures(features, model);
    } catch (const json::exception& e) {
        return Error{Error::Kind::Input, fmt::format("{}: {}", features, e.what())};
    }
    if (!readMesh(mesh, model)) return Error{Error::Kind::Input, "can't read " + mesh};
    return model;
}

}  // namespace sgm::exact

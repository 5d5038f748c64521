#include "modeler/tiles/deliver.h"

#include <fmt/format.h>

#include <set>

#include "modeler/core/atomic_file.h"
#include "modeler/tiles/heights.h"
#include "modeler/tiles/read_back.h"
#include "modeler/tiles/textures.h"
#include "modeler/tiles/tileset.h"
#include "modeler/tiles/usd.h"

namespace sgm::tiles {
namespace {

namespace fs = std::filesystem;

/// Makes the cells of one form, and the objects that they show, each once.
class Writer {
public:
    Writer(const fs::path& folder, const BakePlan& plan, bool usd)
        : plan_(plan), folder_(folder), out_(folder / (usd ? "usd" : "blender")), usd_(usd) {}

    Status cell(const Cell& cell) {
        auto read = readCell(contentFile(folder_, cell), packed_);
        if (!read.ok()) return read.error();
        CellContent& content = read->content;
        content.centre = cell.centre(plan_.side_m);
        for (Part& part : read->parts) part.pose.origin = part.pose.origin + content.centre;
        for (CellObject& object : content.objects)
            if (const Status s = this->object(object); !s.ok()) return s;
        const std::string name = fmt::format("{}_{}", cell.x, cell.z);
        const fs::path file = out_ / "cells" / (name + (usd_ ? ".usda" : ".glb"));
        if (const Status s = makeFolder(file); !s.ok()) return s;
        if (usd_) {
            for (Material& material : content.materials) material.color = farColors_.of(material);
            std::string prim = "Cell_" + name;
            std::replace(prim.begin(), prim.end(), '-', 'm');
            payloads_.push_back({prim, "./cells/" + name + ".usda", content.centre});
            return writeUsdCell(content, file);
        }
        content.packing = Packing::None;
        content.asNodes = true;
        content.pictures = "../lib/textures/";
        if (const Status s = writePictures(content.materials, out_ / "lib" / "textures"); !s.ok()) return s;
        const auto written = writeCell(content, plain_, file);
        return written.ok() ? Status(Done{}) : Status(written.error());
    }

    Status finish() const { return usd_ ? writeUsdStage(payloads_, out_ / "city.usda") : Status(Done{}); }

private:
    static Status makeFolder(const fs::path& file) {
        std::error_code failed;
        fs::create_directories(file.parent_path(), failed);
        return failed ? Status(writeError(file, failed.message())) : Status(Done{});
    }

    /// Lets the object's place in the cell name its new file, which is made with its first use.
    Status object(CellObject& object) {
        const fs::path held = object.path;
        fs::path name = fs::path("lib") / held.parent_path().filename() / held.stem();
        name += usd_ ? ".usda" : ".glb";
        object.file = "../" + name.string();
        object.path = out_ / name;
        if (!made_.insert(name.string()).second) return Done{};
        auto read = readObject(held);
        if (!read.ok()) return read.error();
        if (usd_)
            for (Material& material : read->materials) material.color = farColors_.of(material);
        if (const Status s = makeFolder(object.path); !s.ok()) return s;
        return usd_ ? writeUsdObject(*read, object.path) : writeObject(*read, Packing::None, object.path);
    }

    const BakePlan& plan_;
    const fs::path folder_, out_;
    const bool usd_;
    Library packed_, plain_;
    FarColors farColors_;  ///< what stands in USD for pictures
    std::set<std::string> made_;
    std::vector<UsdPayload> payloads_;
};

}  // namespace

Status deliver(const fs::path& folder, Delivery delivery, Progress* progress) {
    if (delivery == Delivery::Heights) return writeHeights(folder, progress);
    const auto plan = readPlan(folder);
    if (!plan.ok()) return plan.error();
    Writer writer(folder, *plan, delivery == Delivery::Usd);
    if (progress) progress->begin("write", plan->cells.size());
    for (const Cell& cell : plan->cells) {
        if (cancelled(progress)) return cancelledError();
        tick(progress);
        std::error_code ignored;
        if (cell.level != 0 || !fs::exists(contentFile(folder, cell), ignored)) continue;
        if (const Status s = writer.cell(cell); !s.ok()) return s;
    }
    return writer.finish();
}

}  // namespace sgm::tiles

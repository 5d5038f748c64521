// The Export panel: every format's options from the table of exporters, and the work on a thread of its own.
// Enters: a model, a file's name, options. Leaves: the file, or an error; nothing half-written. Assumes that one thread
// calls it.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "modeler/export/exporter.h"
#include "modeler/mesh/connected_components.h"
#include "viewer/document/session.h"

namespace sgm::document {

/// One option as a dialog shows it: a combo of `choices`, or a number in lo … hi, or text.
struct ExportRow {
    std::string name, doc;
    std::string value;                 ///< the default at first
    std::vector<std::string> choices;  ///< empty: a number or text
    bool number = false;
    double lo = 0, hi = 0;
};
/// The options of a format; empty where it has none.
std::vector<ExportRow> exportRows(const exporter::Exporter& format);

struct ExportRequest {
    std::filesystem::path file;  ///< the format by its ending
    exporter::ExportOptions options;
    int resolution = 128;  ///< cells along the longest side
    double cell_m = 0;     ///< > 0 wins over resolution
    int threads = 0;
    mesh::Keep keep = mesh::Keep::All;               ///< which separate solids are written
    std::string objects = {};                        ///< as lower::parseObjects reads it, for formats that hold objects
    std::vector<std::filesystem::path> inputs = {};  ///< what the model is made from, which is never replaced
};

class ExportJob {
public:
    ~ExportJob();
    ExportJob() = default;
    ExportJob(const ExportJob&) = delete;
    ExportJob& operator=(const ExportJob&) = delete;

    /// Begins. Error::Usage at once for an ending or an option that no format takes, Error::Input for a missing folder,
    /// for a file that is an input, and while another export runs. `notify` is called from the thread at its end.
    Status start(std::shared_ptr<const BuiltModel> shown, ExportRequest request,
                 std::function<void()> notify = nullptr);
    void cancel() { progress_->cancel(); }
    /// From `start` until the outcome is taken.
    bool running() const { return thread_.joinable(); }
    std::string_view stage() const { return progress_->stage(); }
    double fraction() const { return progress_->fraction(); }
    /// What it writes, or wrote last.
    const std::filesystem::path& file() const { return file_; }
    /// The outcome, once, when it has ended.
    std::optional<Status> take();

private:
    std::shared_ptr<Progress> progress_ = std::make_shared<Progress>();
    std::thread thread_;
    std::filesystem::path file_;
    std::atomic<bool> done_{false};
    std::optional<Status> outcome_;
};

}  // namespace sgm::document

// sgm mutate: a contact sheet of variations of a model, and the chosen one written back as a style.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>

#include "cli/commands.h"
#include "cli/messages.h"
#include "cli/validators.h"
#include "cli/variations.h"
#include "cli/watch.h"
#include "grammar/operations/operations.h"
#include "grammar/pipeline/files.h"
#include "grammar/pipeline/missing.h"
#include "grammar/rules/params.h"
#include "grammar/syntax/parser.h"
#include "modeler/core/atomic_file.h"
#include "modeler/core/lower_case.h"
#include "modeler/core/random.h"
#include "viewer/render/draw.h"

namespace sgm::cli {
namespace {

using document::edits::NamedValue;

struct MutateRequest {
    ModelRequest model;
    std::string output, size = "320x320", save;
    std::vector<std::string> lock;
    int rows = 3, columns = 4, pick = -1, resolution = 96, threads = 0;
    double spread = 0.35;
    bool quiet = false;
};

/// A variation that is good to look at; the first one is the model as it is.
struct Variation {
    std::vector<NamedValue> values;
    Model model;
};

pipeline::ModelChoice with(const MutateRequest& request, const std::vector<NamedValue>& values) {
    pipeline::ModelChoice choice = request.model;
    for (const NamedValue& v : values) choice.settings.push_back(v.name + "=" + v.value);
    return choice;
}

Result<pipeline::MeshedModel> meshOf(const MutateRequest& request, const Model& model, int halvings, Context& context) {
    GridRequest grid;
    grid.resolution = request.resolution;
    grid.halvings = halvings;
    grid.threads = request.threads;
    return makeMesh(model, grid, context);
}

/// Why a model isn't worth a look, or nothing: by a mesh of cells as they are, which takes little time, and by one of
/// halved cells where that finds a fault or doesn't show the gaps. Featureless ones are looked at again if that is a
/// fault.
Result<std::string> judge(const MutateRequest& request, const Model& model, bool isBareFault, Context& context) {
    for (const int halvings : {0, GridRequest{}.halvings}) {
        const auto meshed = meshOf(request, model, halvings, context);
        if (!meshed.ok()) return meshed.error();
        const std::string why = degenerate(meshed->mesh, meshed->grid.cell_m).value_or("");
        const bool isGood = why.empty() || (why == featureless && !isBareFault);
        if (halvings > 0 || (isGood && !mayFloat(model.derivation))) return why;
    }
    return std::string();
}

/// What the mesh shows, as other commands tell it.
Result<std::vector<pipeline::MeshWarning>> warningsOf(const MutateRequest& request, const Model& model,
                                                      Context& context) {
    const auto meshed = meshOf(request, model, GridRequest{}.halvings, context);
    if (!meshed.ok()) return meshed.error();
    return pipeline::meshWarnings(model, *meshed, context);
}

/// The model, or why it isn't one worth showing.
struct Tried {
    std::optional<Model> model;
    std::string why;
    std::vector<pipeline::MeshWarning> warnings;  ///< of the model as it is
    bool isFeatureless = false;                   ///< a few planes and nothing on them
};
/// A featureless model is worth showing where `mayBeFeatureless`.
Result<Tried> tried(const MutateRequest& request, const std::shared_ptr<const rules::Grammar>& grammar,
                    const std::vector<NamedValue>& values, bool mayBeFeatureless, Progress* progress) {
    const auto options = optionsFor(*grammar, with(request, values));
    if (!options.ok()) return options.error();
    Context context{progress, request.threads};
    auto model = makeModel(grammar, *options, context, pipeline::Objects::Sketched);
    if (!model.ok()) {
        if (model.error().kind == Error::Kind::Cancelled) return model.error();
        return Tried{{}, "empty", {}, false};
    }
    auto judged = judge(request, *model, values.empty() || !mayBeFeatureless, context);
    if (!judged.ok()) return judged.error();
    std::vector<pipeline::MeshWarning> warnings;
    if (values.empty() && !request.quiet) {
        auto found = warningsOf(request, *model, context);
        if (!found.ok()) return found.error();
        warnings = std::move(*found);
    }
    const bool isFeatureless = *judged == featureless;
    if (!judged->empty() && !(isFeatureless && mayBeFeatureless))
        return Tried{{}, std::move(*judged), std::move(warnings), isFeatureless};
    return Tried{std::move(*model), {}, std::move(warnings), isFeatureless};
}

/// "wide=3 tall=4"; "as it is" where nothing is changed.
std::string worded(const std::vector<NamedValue>& values) {
    std::string text;
    for (const NamedValue& v : values) text += fmt::format("{}{}={}", text.empty() ? "" : " ", v.name, v.value);
    return text.empty() ? "as it is" : text;
}

/// Good variations until the sheet is full, none of them twice; a candidate is known by its number, so that the same
/// sheet comes again.
Result<std::vector<Variation>> search(const MutateRequest& request,
                                      const std::shared_ptr<const rules::Grammar>& grammar, size_t wanted,
                                      Progress* progress) {
    std::vector<Variation> found;
    std::map<std::string, int> rejected;
    const std::set<std::string> locked(request.lock.begin(), request.lock.end());
    std::set<std::string> seen;
    const size_t most = 8 * wanted + 16;
    bool mayBeFeatureless = true;  // as the model itself is
    for (size_t k = 0; found.size() < wanted && k < most; ++k) {
        std::vector<NamedValue> values;
        if (k > 0) values = variation(*grammar, request.model, locked, request.spread, combine(request.model.seed, k));
        if (!seen.insert(worded(values)).second) {
            ++rejected["the same as another"];
            continue;
        }
        auto one = tried(request, grammar, values, mayBeFeatureless, progress);
        if (!one.ok()) return one.error();
        if (k == 0) mayBeFeatureless = one->isFeatureless;
        if (k == 0 && one->model && !request.quiet) printWarnings(*one->model);
        printMeshWarnings(one->warnings);
        if (one->model)
            found.push_back({std::move(values), std::move(*one->model)});
        else
            ++rejected[one->why];
    }
    if (!request.quiet)
        for (const auto& [why, count] : rejected) fmt::print("rejected {}: {}\n", count, why);
    if (found.empty())
        return Error{
            Error::Kind::Input,
            fmt::format("none of {} variations is worth a look: all are empty, dust, floating or featureless", most)};
    return found;
}

/// A number in the picture's corner, of squares three by five to a digit.
void stamp(render::Image& image, int x, int y, int number) {
    constexpr uint16_t digits[] = {0x7b6f, 0x2492, 0x73e7, 0x73cf, 0x5bc9, 0x79cf, 0x79ef, 0x7249, 0x7bef, 0x7bcf};
    const int dot = std::max(1, image.width / 700);
    const std::string text = std::to_string(number);
    for (size_t k = 0; k < text.size(); ++k)
        for (int bit = 0; bit < 15; ++bit) {
            if (!(digits[text[k] - '0'] >> (14 - bit) & 1)) continue;
            for (int i = 0; i < 2 * dot; ++i)
                for (int j = 0; j < 2 * dot; ++j) {
                    const int px = x + (static_cast<int>(k) * 4 + bit % 3) * 2 * dot + i,
                              py = y + bit / 3 * 2 * dot + j;
                    for (int c = 0; c < 3; ++c)
                        image.rgb[(static_cast<size_t>(py) * static_cast<size_t>(image.width) +
                                   static_cast<size_t>(px)) *
                                      3 +
                                  static_cast<size_t>(c)] = 20;
                }
        }
}

Result<render::Image> sheet(const MutateRequest& request, const std::vector<Variation>& found,
                            render::PictureOptions options, Progress* progress) {
    render::Image all{request.columns * options.width, request.rows * options.height, {}};
    all.rgb.assign(static_cast<size_t>(all.width) * static_cast<size_t>(all.height) * 3, 255);
    const double aspect = static_cast<double>(options.width) / options.height;
    for (size_t k = 0; k < found.size(); ++k) {
        const Model& model = found[k].model;
        const Box3f bounds = render::tighten(model.tape, model.lowered->field.bounds);
        options.camera = render::frame(model.tape, bounds, aspect);
        const auto image = render::drawField(model.tape, bounds, model.lowered->provenance, options, progress);
        if (!image.ok()) return image.error();
        const int left = static_cast<int>(k) % request.columns * options.width,
                  top = static_cast<int>(k) / request.columns * options.height;
        for (int y = 0; y < options.height; ++y)
            std::copy_n(image->rgb.begin() + static_cast<ptrdiff_t>(y) * options.width * 3,
                        static_cast<ptrdiff_t>(options.width) * 3,
                        all.rgb.begin() + (static_cast<ptrdiff_t>(top + y) * all.width + left) * 3);
        stamp(all, left + 8, top + 8, static_cast<int>(k));
    }
    return all;
}

/// The chosen one's values as a style of the file.
Status saveChoice(const MutateRequest& request, const rules::Grammar& grammar, const std::vector<Variation>& found) {
    if (request.pick >= static_cast<int>(found.size()))
        return Error{Error::Kind::Usage,
                     fmt::format("--pick {}: the sheet has 0 … {}", request.pick, found.size() - 1)};
    const syntax::SourcePtr& source = grammar.sources[0];
    if (const Status s = checkUnchanged(request.model.file, grammar); !s.ok()) return s;
    syntax::Diagnostics diagnostics;
    const syntax::Ast ast = syntax::parse(source, operations::table(), diagnostics);
    std::vector<NamedValue> values;
    const auto add = [&](const NamedValue& v) {
        std::erase_if(values, [&](const NamedValue& w) { return w.name == v.name; });
        values.push_back(v);
    };
    const auto options = optionsFor(grammar, request.model);
    if (!options.ok()) return options.error();
    const auto fresh = rules::valuesOf(grammar, options->start);
    for (size_t i = 0; i < fresh.size(); ++i)  // what --style and --set changed belongs to it too
        if (options->params[i] != fresh[i]) add({grammar.params[i].name, rules::toText(options->params[i])});
    for (const NamedValue& v : found[static_cast<size_t>(request.pick)].values) add(v);
    const std::string start = grammar.symbols[grammar.starts[options->start].symbol].name;
    const auto edit = document::edits::saveStyle(ast, request.save, start, values);
    if (!edit.ok()) return edit.error();
    return writeFile(request.model.file, document::applied(source->text(), *edit));
}

Status checkRequest(const MutateRequest& request, const rules::Grammar& grammar) {
    if ((request.pick >= 0) != !request.save.empty())
        return Error{Error::Kind::Usage,
                     "--pick NUMBER and --save NAME go together: which one, and the style it becomes"};
    if (!request.save.empty() && !syntax::isWord(request.save))
        return Error{
            Error::Kind::Usage,
            fmt::format(
                "--save '{}': the name of a style is letters, digits and '_', and no digit first, as in My_style",
                request.save)};
    const auto style = std::find_if(grammar.styles.begin(), grammar.styles.end(),
                                    [&](const rules::Style& s) { return s.name == request.save; });
    if (style != grammar.styles.end())
        return Error{Error::Kind::Input, fmt::format("{}there is a style '{}' already: save under another name",
                                                     syntax::placeText(style->span), request.save)};
    std::vector<std::string> names;
    for (const rules::Param& p : grammar.params) names.push_back(p.name);
    for (const std::string& name : request.lock) {
        if (std::find(names.begin(), names.end(), name) != names.end()) continue;
        const std::string near = syntax::didYouMean(name, names);
        return Error{
            Error::Kind::Usage,
            fmt::format("--lock {}: no parameter is called so{}; {}", name,
                        near.empty() ? "" : fmt::format(" (did you mean '{}'?)", near),
                        names.empty() ? "the grammar has none" : fmt::format("there are {}", fmt::join(names, ", ")))};
    }
    if (request.rows * request.columns > 1 &&
        !canVary(grammar, request.model, {request.lock.begin(), request.lock.end()}))
        return Error{Error::Kind::Input,
                     request.lock.empty()
                         ? "there is no parameter to vary: declare one with a range, as 'param wide = 4m in 2m..8m'"
                         : "there is no parameter to vary: --lock leaves none with a range or choices"};
    return Done{};
}

Status mutated(const MutateRequest& request) {
    render::PictureOptions options;
    int used = 0;
    if (std::sscanf(request.size.c_str(), "%dx%d%n", &options.width, &options.height, &used) != 2 ||
        used != static_cast<int>(request.size.size()) || std::min(options.width, options.height) < 32 ||
        std::max(options.width, options.height) > 4096)
        return Error{Error::Kind::Usage,
                     fmt::format("--size {}: write WIDTHxHEIGHT of one picture in pixels, as 320x240", request.size)};
    if (const Status s = checkTargets(request.model.targets); !s.ok()) return s;
    Watch watch(request.quiet);
    Context context{watch.progress()};
    const auto loaded = loadGrammar(request.model, context);
    if (!loaded.ok()) return loaded.error();
    const std::shared_ptr<const rules::Grammar>& grammar = *loaded;
    if (const Status s = checkRequest(request, *grammar); !s.ok()) return s;
    const size_t wanted = static_cast<size_t>(request.rows) * static_cast<size_t>(request.columns);
    const auto found = search(request, grammar, wanted, watch.progress());
    if (!found.ok()) return found.error();
    if (!request.output.empty()) {
        options.threads = request.threads;
        options.samples = 3;
        const auto image = sheet(request, *found, options, watch.progress());
        if (!image.ok()) return image.error();
        if (const Status s = render::writePng(*image, request.output); !s.ok()) return s;
        if (!request.quiet) fmt::print("wrote {}\n", request.output);
    }
    if (!request.quiet)
        for (size_t k = 0; k < found->size(); ++k) fmt::print("{}: {}\n", k, worded((*found)[k].values));
    if (request.output.empty() && request.pick < 0 && !request.quiet)
        printMessage("note: nothing was drawn: add -o sheet.png\n");
    if (request.pick < 0) return Done{};
    if (const Status s = saveChoice(request, *grammar, *found); !s.ok()) return s;
    if (!request.quiet) fmt::print("wrote style {} into {}\n", request.save, request.model.file);
    return Done{};
}

int mutate(MutateRequest request) {
    request.model.quiet = request.quiet;
    if (!request.output.empty() && !lowerCase(request.output).ends_with(".png"))
        return fail({Error::Kind::Usage, fmt::format("'{}': sheets are .png", request.output)});
    if (!request.output.empty()) request.model.targets.push_back({"-o", request.output});
    const Status done = mutated(request);
    return done.ok() ? 0 : fail(done.error());
}

}  // namespace

void addMutate(CLI::App& app, int& exitCode) {
    CLI::App* command =
        app.add_subcommand("mutate", "Draw a sheet of variations of a model; write the chosen one back as a style");
    auto request = std::make_shared<MutateRequest>();
    addModelOptions(*command, request->model);
    command->add_option("-o,--output", request->output, "Sheet to write (.png)");
    command->add_option("--rows", request->rows, "Rows of the sheet")->check(wholeNumber(1, 20))->capture_default_str();
    command->add_option("--cols", request->columns, "Columns of the sheet")
        ->check(wholeNumber(1, 20))
        ->capture_default_str();
    command->add_option("--size", request->size, "Pixels of one picture, WxH")->capture_default_str();
    command->add_option("--lock", request->lock, "Leave a parameter as it is; may be given again")
        ->allow_extra_args(false);
    command->add_option("--spread", request->spread, "How far values go: 0 not at all, 1 anywhere in their ranges")
        ->check(between(0, 1))
        ->capture_default_str();
    command->add_option("--resolution", request->resolution, "Cells along the longest side of the mesh that is judged")
        ->check(wholeNumber(16, 1024))
        ->capture_default_str();
    command->add_option("--threads", request->threads, "Threads (0: all)")
        ->check(wholeNumber(0, 1024))
        ->capture_default_str();
    command->add_option("--pick", request->pick, "Number of the variation to keep")->check(wholeNumber(0, 1000));
    command->add_option("--save", request->save, "Name of the style it becomes");
    command->add_flag("-q,--quiet", request->quiet, "Say nothing but errors");
    command->footer(
        "Examples:\n  sgm mutate examples/kifs/mcgraw.sgm --rows 3 --cols 4 --lock mass -o sheet.png\n  sgm mutate "
        "mine.sgm --pick 7 --save Lucky");
    command->callback([request, &exitCode] { exitCode = mutate(*request); });
}

}  // namespace sgm::cli

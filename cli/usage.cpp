#include "cli/usage.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string_view>
#include <vector>

#include "grammar/syntax/source.h"

namespace sgm::cli {
namespace {

/// "--cell" of "--cell=.1"; empty for what is no option. A negative number is a value.
std::string optionName(std::string_view word) {
    const bool isOption =
        word.size() > 1 && word[0] == '-' && (word[1] == '-' || std::isalpha(static_cast<unsigned char>(word[1])));
    if (!isOption || word == "--") return {};
    if (word[1] != '-') return std::string(word.substr(0, 2));  // -o and what is glued to it
    return std::string(word.substr(0, word.find('=')));
}

std::vector<std::string> optionsOf(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

bool has(const CLI::App& app, const std::string& option) { return app.get_option_no_throw(option) != nullptr; }

std::string commandProblem(const CLI::App& app, const std::string& word) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(command->get_name());
    const std::string near = syntax::didYouMean(word, names);
    if (!near.empty()) return fmt::format("no command '{}'; did you mean '{}'?", word, near);
    return fmt::format("no command '{}': there are {}", word, fmt::join(names, ", "));
}

std::string optionProblem(const CLI::App& app, const CLI::App& command, const std::string& option) {
    std::vector<std::string> others;
    for (const CLI::App* other : app.get_subcommands([](const CLI::App*) { return true; }))
        if (other != &command && has(*other, option)) others.push_back(fmt::format("'sgm {}'", other->get_name()));
    if (!others.empty())
        return fmt::format("'sgm {}' has no option {}: it belongs to {}", command.get_name(), option,
                           fmt::join(others, ", "));
    const std::string near = syntax::didYouMean(option, optionsOf(command));
    return fmt::format("'sgm {}' has no option {}{}", command.get_name(), option,
                       near.empty() ? "" : fmt::format("; did you mean {}?", near));
}

}  // namespace

std::string usageProblem(const CLI::App& app, int argc, const char* const* argv) {
    const CLI::App* command = nullptr;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i], option = optionName(word);
        if (!command && option.empty()) {
            for (const CLI::App* each : app.get_subcommands([](const CLI::App*) { return true; }))
                if (each->check_name(word)) command = each;
            if (!command) return commandProblem(app, word);
        } else if (!option.empty() && has(app, option)) {
            if (word == option && app.get_option(option)->get_expected_min() > 0) ++i;  // its value
        } else if (command && !option.empty() && !has(*command, option)) {
            return optionProblem(app, *command, option);
        }
    }
    return {};
}

}  // namespace sgm::cli

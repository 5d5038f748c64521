// sgm completion and sgm man: what shells complete and the manual page, from the tables of the command line itself.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/validators.h"

namespace sgm::cli {
namespace {

using Options = std::vector<const CLI::Option*>;

std::vector<const CLI::App*> commandsOf(const CLI::App& app) {
    return app.get_subcommands([](const CLI::App*) { return true; });
}

/// The options that are written with their name; those of an empty group are hidden.
Options namedOptions(const CLI::App& app) {
    Options options;
    for (const CLI::Option* o : app.get_options())
        if (o->nonpositional() && !o->get_group().empty()) options.push_back(o);
    return options;
}

/// "--surface" or "-q", the long name first.
std::vector<std::string> namesOf(const CLI::Option& option) {
    std::vector<std::string> names;
    for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option.get_snames()) names.push_back("-" + name);
    return names;
}

bool takesValue(const CLI::Option& option) { return option.get_expected_max() > 0; }

/// The words that an option takes, as its help shows them: {crisp,cubes}.
std::vector<std::string> choicesOf(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    const size_t open = type.find('{'), close = type.find('}');
    std::vector<std::string> words;
    if (open == std::string::npos || close == std::string::npos) return words;
    for (size_t at = open + 1; at < close;) {
        const size_t end = std::min(type.find(',', at), close);
        const std::string word = type.substr(at, end - at);
        words.push_back(word.substr(0, word.find("->")));  // a choice may show its number
        at = end + 1;
    }
    return words;
}

/// Whether files are meant: FILE, or an option that names one.
bool takesFile(const CLI::Option& option) {
    const std::string name = option.get_lnames().empty() ? "" : option.get_lnames()[0];
    return choicesOf(option).empty() &&
           (name == "output" || name == "report" || name == "proxy" || name == "floor" || name == "file");
}

std::string quoted(std::string text) {
    for (size_t at = 0; (at = text.find('\'', at)) != std::string::npos; at += 4) text.replace(at, 1, "'\\''");
    return "'" + text + "'";
}

std::string bashScript(const CLI::App& app) {
    std::vector<std::string> names;
    std::string values, options;
    for (const CLI::App* command : commandsOf(app)) {
        names.push_back(command->get_name());
        std::vector<std::string> words;
        for (const CLI::Option* o : namedOptions(*command)) {
            const auto own = namesOf(*o);
            words.insert(words.end(), own.begin(), own.end());
            if (!takesValue(*o)) continue;
            for (const std::string& name : own) {
                const auto choices = choicesOf(*o);
                const std::string reply = !choices.empty()
                                              ? fmt::format("compgen -W '{}' -- \"$word\"", fmt::join(choices, " "))
                                          : takesFile(*o) ? "compgen -f -- \"$word\""
                                                          : "";
                values += fmt::format("        {}:{}) COMPREPLY=({}); return ;;\n", command->get_name(), name,
                                      reply.empty() ? "" : "$(" + reply + ")");
            }
        }
        options += fmt::format("        {}) options='{}' ;;\n", command->get_name(), fmt::join(words, " "));
    }
    return fmt::format(R"(# bash completion for sgm, printed by `sgm completion bash`
_sgm() {{
    local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} command= options= i
    for ((i = 1; i < COMP_CWORD; i++)); do
        case ${{COMP_WORDS[i]}} in {0}) command=${{COMP_WORDS[i]}}; break ;; esac
    done
    case $command:$before in
{1}    esac
    case $command in
        '') COMPREPLY=($(compgen -W '{2} --help --version' -- "$word")); return ;;
{3}    esac
    if [[ $word == -* ]]; then
        COMPREPLY=($(compgen -W "$options" -- "$word"))
    else
        COMPREPLY=($(compgen -f -X '!*.sgm' -- "$word") $(compgen -d -- "$word"))
    fi
}}
complete -o filenames -F _sgm sgm
)",
                       fmt::join(names, "|"), values, fmt::join(names, " "), options);
}

std::string fishScript(const CLI::App& app) {
    std::string script = "# fish completion for sgm, printed by `sgm completion fish`\ncomplete -c sgm -f\n";
    for (const CLI::App* command : commandsOf(app)) {
        script += fmt::format("complete -c sgm -n __fish_use_subcommand -a {} -d {}\n", command->get_name(),
                              quoted(command->get_description()));
        const std::string within =
            fmt::format("complete -c sgm -n '__fish_seen_subcommand_from {}'", command->get_name());
        script += within + " -k -a '(__fish_complete_suffix .sgm)'\n";
        for (const CLI::Option* o : namedOptions(*command)) {
            std::string line = within;
            for (const std::string& name : o->get_lnames()) line += " -l " + name;
            for (const std::string& name : o->get_snames()) line += " -s " + name;
            const auto choices = choicesOf(*o);
            if (!choices.empty())
                line += fmt::format(" -x -a '{}'", fmt::join(choices, " "));
            else if (takesFile(*o))
                line += " -r -F";
            else if (takesValue(*o))
                line += " -x";
            script += line + " -d " + quoted(o->get_description()) + "\n";
        }
    }
    return script;
}

/// Text within the brackets and colons of zsh's _arguments.
std::string forZsh(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '[' || c == ']' || c == ':' || c == '\\') escaped += '\\';
        escaped += c;
    }
    return escaped;
}

std::string zshScript(const CLI::App& app) {
    std::string script =
        "#compdef sgm\n# zsh completion for sgm, printed by `sgm completion zsh`\n_sgm() {\n    local -a commands=(\n";
    for (const CLI::App* command : commandsOf(app))
        script += "        " + quoted(command->get_name() + ":" + forZsh(command->get_description())) + "\n";
    script += "    )\n    if (( CURRENT == 2 )); then _describe command commands; return; fi\n    case $words[2] in\n";
    for (const CLI::App* command : commandsOf(app)) {
        script += fmt::format("        {}) _arguments", command->get_name());
        for (const CLI::Option* o : namedOptions(*command))
            for (const std::string& name : namesOf(*o)) {
                const auto choices = choicesOf(*o);
                std::string value;
                if (!choices.empty())
                    value = fmt::format(":value:({})", fmt::join(choices, " "));
                else if (takesFile(*o))
                    value = ":file:_files";
                else if (takesValue(*o))
                    value = ":value:";
                script += " \\\n            " + quoted("*" + name + "[" + forZsh(o->get_description()) + "]" + value);
            }
        script += " \\\n            '*:grammar:_files -g \"*.sgm\"' ;;\n";
    }
    return script + "    esac\n}\n_sgm \"$@\"\n";
}

/// Text for roff: no line begins with a control character, and a hyphen stays one.
std::string roff(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        if ((c == '.' || c == '\'') && (escaped.empty() || escaped.back() == '\n')) escaped += "\\&";
        if (c == '\\')
            escaped += "\\e";
        else if (c == '-')
            escaped += "\\-";
        else
            escaped += c;
    }
    return escaped;
}

std::string manPage(const CLI::App& app, const std::string& version) {
    std::string page = fmt::format(
        ".TH SGM 1 \"\" \"sgm {}\" \"User Commands\"\n.SH NAME\nsgm \\- {}\n.SH SYNOPSIS\n.B sgm\n.I "
        "COMMAND\n[\\fIOPTIONS\\fR] [\\fIFILE\\fR]\n",
        version, roff(app.get_description().substr(app.get_description().find(": ") + 2)));
    const auto options = [&](const CLI::App& of) {
        for (const CLI::Option* o : namedOptions(of)) {
            std::string names;
            for (const std::string& name : namesOf(*o))
                names += (names.empty() ? "\\fB" : ", \\fB") + roff(name) + "\\fR";
            const std::string value =
                takesValue(*o)
                    ? " \\fI" +
                          roff(choicesOf(*o).empty() ? "VALUE" : fmt::format("{}", fmt::join(choicesOf(*o), "|"))) +
                          "\\fR"
                    : "";
            const std::string usual = o->get_default_str().empty() ? "" : " (" + roff(o->get_default_str()) + ")";
            page += fmt::format(".TP\n{}{}\n{}{}\n", names, value, roff(o->get_description()), usual);
        }
    };
    page += ".SH OPTIONS\n";
    options(app);
    for (const CLI::App* command : commandsOf(app)) {
        std::string heading = command->get_name();
        std::transform(heading.begin(), heading.end(), heading.begin(),
                       [](unsigned char c) { return std::toupper(c); });
        page += fmt::format(".SH SGM {}\n{}.\n", roff(heading), roff(command->get_description()));
        options(*command);
    }
    return page + ".SH EXAMPLES\n.nf\n" + roff(app.get_footer()) + "\n.fi\n";
}

}  // namespace

void addShell(CLI::App& app, int& exitCode) {
    CLI::App* completion =
        app.add_subcommand("completion", "Print the script that completes commands and options in a shell");
    auto shell = std::make_shared<std::string>();
    completion->add_option("SHELL", *shell, "bash, zsh or fish")->required()->check(oneOf({"bash", "zsh", "fish"}));
    completion->footer(
        "Examples:\n  source <(sgm completion bash)\n"
        "  sgm completion fish > ~/.config/fish/completions/sgm.fish");
    completion->callback([&app, shell, &exitCode] {
        fmt::print("{}", *shell == "bash" ? bashScript(app) : *shell == "zsh" ? zshScript(app) : fishScript(app));
        exitCode = 0;
    });
    CLI::App* man = app.add_subcommand("man", "Print the manual page, for `man -l -`");
    man->footer("Example:\n  sgm man | man -l -");
    man->callback([&app, &exitCode] {
        fmt::print("{}", manPage(app, SGM_VERSION));
        exitCode = 0;
    });
}

}  // namespace sgm::cli

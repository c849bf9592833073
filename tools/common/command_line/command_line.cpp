#include "common/command_line/command_line.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <stdexcept>

#include <getopt.h>

extern "C" {
#include "base/version.h"
}

namespace cli
{

namespace
{

/* getopt's names for the options: above all characters. */
constexpr int first_choice = 256;

/* Results that did not arrive are a failure, however late that shows. */
void check_output()
{
    errno = EIO;
    if (std::fflush(stdout) != 0 || std::ferror(stdout)) {
        throw std::runtime_error(std::string("standard output: ") + std::strerror(errno));
    }
}

} // namespace

CommandLine::CommandLine(std::string program, std::string usage)
    : program_(std::move(program)), usage_(std::move(usage))
{
    const auto answer = [this](const std::string &name, const std::string &text) {
        options_.push_back({name, false, [text](const std::string &) {
                                std::fputs(text.c_str(), stdout);
                                throw Answered();
                            }});
    };
    answer("help", usage_);
    answer("version", program_ + " " ALE_VERSION "\n");
}

void CommandLine::flag(const std::string &name, bool &value, bool meaning)
{
    options_.push_back({name, false, [&value, meaning](const std::string &) { value = meaning; }});
}

void CommandLine::option(const std::string &name, Take take)
{
    options_.push_back({name, true, std::move(take)});
}

void CommandLine::text(const std::string &name, std::string &value)
{
    option(name, [&value](const std::string &word) { value = word; });
}

void CommandLine::texts(const std::string &name, std::vector<std::string> &values)
{
    option(name, [&values](const std::string &word) { values.push_back(word); });
}

void CommandLine::argument(const std::string &title, Take take)
{
    arguments_.push_back({title, std::move(take), true});
}

void CommandLine::argument(const std::string &title, std::string &value)
{
    argument(title, [&value](const std::string &word) { value = word; });
}

void CommandLine::possible_argument(const std::string &title, std::string &value)
{
    arguments_.push_back({title, [&value](const std::string &word) { value = word; }, false});
}

void CommandLine::arguments(const std::string &title, std::vector<std::string> &values)
{
    words_title_ = title;
    words_ = &values;
}

void CommandLine::rest(std::vector<std::string> &words)
{
    rest_ = &words;
}

void CommandLine::take_option(int choice, char **argv)
{
    const std::string last = argv[optind - 1];
    if (choice == ':') {
        throw WrongUse(last + " wants a value");
    }
    if (choice == '?' && optopt >= first_choice) {
        throw WrongUse("--" + options_[static_cast<size_t>(optopt - first_choice)].name + " takes no value");
    }
    if (choice == '?') {
        throw WrongUse("unknown option " +
                       (optopt == 0 ? last : std::string("-") + static_cast<char>(optopt)));
    }
    const Option &option = options_[static_cast<size_t>(choice - first_choice)];
    if (option.has_word && *optarg == '\0') {
        throw WrongUse("--" + option.name + " wants a value");
    }
    option.take(option.has_word ? optarg : "");
}

void CommandLine::read_options(int argc, char **argv)
{
    std::vector<::option> known;
    known.reserve(options_.size() + 1);
    for (const Option &option : options_) {
        known.push_back({option.name.c_str(), option.has_word ? required_argument : no_argument, nullptr,
                         first_choice + static_cast<int>(known.size())});
    }
    known.push_back({});
    optind = 0; /* GNU: start afresh */
    for (int choice; (choice = getopt_long(argc, argv, rest_ ? "+:" : ":", known.data(), nullptr)) != -1;) {
        take_option(choice, argv);
    }
}

void CommandLine::read_arguments(int argc, char **argv)
{
    if (rest_) {
        rest_->assign(argv + optind, argv + argc);
        return;
    }
    for (const Argument &argument : arguments_) {
        if (optind < argc) {
            argument.take(argv[optind++]);
        } else if (argument.wanted) {
            throw WrongUse(argument.title + " is missing");
        }
    }
    if (words_ && optind == argc) {
        throw WrongUse(words_title_ + " is missing");
    }
    if (words_) {
        words_->assign(argv + optind, argv + argc);
        return;
    }
    if (optind < argc) {
        throw WrongUse(std::string("what is \"") + argv[optind] + "\"?");
    }
}

int CommandLine::obey(int argc, char **argv, const std::function<int()> &work)
{
    try {
        read_options(argc, argv);
        read_arguments(argc, argv);
    } catch (const Answered &) {
        return 0;
    }
    return work();
}

int CommandLine::answer(int argc, char **argv, const std::function<int()> &work)
{
    try {
        const int code = obey(argc, argv, work);
        check_output();
        return code;
    } catch (const WrongUse &error) {
        std::fprintf(stderr, "%s: %s (see --help)\n", program_.c_str(), error.what());
        return 2;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s: %s\n", program_.c_str(), error.what());
        return 1;
    }
}

} // namespace cli

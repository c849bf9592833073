/* A program's command line and its exit code.
 *
 *     int main(int argc, char **argv)
 *     {
 *         std::string url, log;
 *         int seconds = 60;
 *         cli::CommandLine line("ale-watch", usage);
 *         line.text("lcm-url", url);
 *         line.number("seconds", seconds, 1, 3600);
 *         line.argument("LOG", log);
 *         return line.run(argc, argv, [&] { return watch(url, seconds, log); });
 *     }
 *
 * All programs answer --help (the usage) and --version on stdout. What goes wrong is one line on stderr that
 * begins with the program's name: exit code 2 for WrongUse, 1 for any other exception, or when stdout takes
 * no more.
 *
 * Over glibc's getopt_long: options and words in any order, "--name word" or "--name=word", names may be
 * abbreviated, "--" ends the options. Values that are bound must outlive run(). */
#ifndef ALE_COMMON_COMMAND_LINE_COMMAND_LINE_H
#define ALE_COMMON_COMMAND_LINE_COMMAND_LINE_H

#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include "common/command_line/words.h"

namespace cli
{

class CommandLine
{
  public:
    using Take = std::function<void(const std::string &word)>;

    CommandLine(std::string program, std::string usage);

    /* "--name" sets value to meaning. */
    void flag(const std::string &name, bool &value, bool meaning = true);
    /* "--name WORD". An empty word is WrongUse, here and below. */
    void option(const std::string &name, Take take);
    void text(const std::string &name, std::string &value);
    /* May be given several times. */
    void texts(const std::string &name, std::vector<std::string> &values);
    template <class Number> void number(const std::string &name, Number &value, Number low, Number high)
    {
        option(name, [=, &value](const std::string &word) {
            value = number_of<Number>("--" + name, word, low, high);
        });
    }
    template <class Value> void choice(const std::string &name, Value &value, Choices<Value> choices)
    {
        option(name, [=, &value](const std::string &word) { value = choice_of("--" + name, word, choices); });
    }

    /* Words that are no options, in the order of these calls; one that is wanted and missing is WrongUse. */
    void argument(const std::string &title, Take take);
    void argument(const std::string &title, std::string &value);
    void possible_argument(const std::string &title, std::string &value);
    /* All words that are no options, behind the ones above; there must be one. */
    void arguments(const std::string &title, std::vector<std::string> &values);
    /* All from the first word on that is no option, options too: "-0.3" behind a verb is a speed. */
    void rest(std::vector<std::string> &words);

    /* Reads the words, then lets the program do its work; the exit code, which work may return. */
    template <class Work> int run(int argc, char **argv, Work work)
    {
        if constexpr (std::is_void_v<decltype(work())>) {
            return answer(argc, argv, [&] {
                work();
                return 0;
            });
        } else {
            return answer(argc, argv, work);
        }
    }

  private:
    struct Option {
        std::string name;
        bool has_word;
        Take take;
    };
    struct Argument {
        std::string title;
        Take take;
        bool wanted;
    };
    struct Answered {
    };

    int answer(int argc, char **argv, const std::function<int()> &work);
    int obey(int argc, char **argv, const std::function<int()> &work);
    void read_options(int argc, char **argv);
    void take_option(int choice, char **argv);
    void read_arguments(int argc, char **argv);

    std::string program_;
    std::string usage_;
    std::vector<Option> options_;
    std::vector<Argument> arguments_;
    std::string words_title_;
    std::vector<std::string> *words_ = nullptr;
    std::vector<std::string> *rest_ = nullptr;
};

} // namespace cli

#endif

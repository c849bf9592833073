/* Files that several programs are told of: the robot's configuration, and pictures of the map. */
#ifndef ALE_COMMON_COMMAND_LINE_ROBOT_FILES_H
#define ALE_COMMON_COMMAND_LINE_ROBOT_FILES_H

#include <string>

#include "common/command_line/command_line.h"

extern "C" {
#include "config/config.h"
}

namespace cli
{

/* Takes what the file says over what config holds. Throws WrongUse that names file, line and key. */
void load_config(const std::string &path, ale_config_t &config);

/* "--NAME MODEL", a preset of scanners.ini; another is WrongUse that lists them. */
void scanner_model(CommandLine &line, const std::string &name, std::string &model);

/* "--map FILE" of a kind that write_map_image() can write; another is WrongUse. */
void map_image(CommandLine &line, std::string &path);
/* The same, as often as wanted. */
void map_images(CommandLine &line, std::vector<std::string> &paths);

/* "--NAME F.svg" of what is drawn as SVG and as nothing else: a name that promises another kind is
 * WrongUse. */
void drawing(CommandLine &line, const std::string &name, std::string &path);

} // namespace cli

#endif

// burin render: a picture of an asset, or its heights from straight above.
#include <cmath>
#include <string>

#include <burin/image_io.hpp>
#include <burin/model.hpp>

#include <gl/render.hpp>

#include "asset_file.hpp"
#include "command.hpp"
#include "options.hpp"
#include "report.hpp"

#pragma once

// Another project's header of a usual name.
#define CONSUMER_BASE_ERROR 1

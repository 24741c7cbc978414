#pragma once

/* Everything Abut offers */
#include <abutscene.h>

#pragma once

#include <abutsys.h>
#include <petsc/private/petscimpl.h>

// SPDX-License-Identifier: Apache-2.0
// Asio is compiled once per program; the rig is a program of its own.
#include <utility>

#include <boost/asio/impl/src.hpp>

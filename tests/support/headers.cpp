// SPDX-License-Identifier: Apache-2.0
// Nothing of its own: a target that only makes a precompiled header needs a source.

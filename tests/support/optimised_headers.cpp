// SPDX-License-Identifier: Apache-2.0
// Nothing of its own: the target that makes the precompiled header of references and evaluation needs a source.

# SPDX-License-Identifier: Apache-2.0
IDENTITY = "closed_loop"
TITLE = "closed_loop"
INTRODUCTION = ""


def content(run):
    return []

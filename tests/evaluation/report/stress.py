# SPDX-License-Identifier: Apache-2.0
IDENTITY = "stress"
TITLE = "stress"
INTRODUCTION = ""


def content(run):
    return []

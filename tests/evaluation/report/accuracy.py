# SPDX-License-Identifier: Apache-2.0
IDENTITY = "accuracy"
TITLE = "accuracy"
INTRODUCTION = ""


def content(run):
    return []

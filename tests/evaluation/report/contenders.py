# SPDX-License-Identifier: Apache-2.0
IDENTITY = "contenders"
TITLE = "contenders"
INTRODUCTION = ""


def content(run):
    return []

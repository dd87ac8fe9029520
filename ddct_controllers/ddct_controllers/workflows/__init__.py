# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `design`: from specifications to a verified controller, and its robustness."""

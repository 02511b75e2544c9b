"""The battery for importers: its checks, and the report of what they found."""

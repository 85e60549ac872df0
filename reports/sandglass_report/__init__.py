"""The report of the project: verdicts and result files -> one page; figures of its texts."""

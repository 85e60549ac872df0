"""The report of the project: verdicts and result files -> one page and static figures."""

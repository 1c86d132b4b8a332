"""The documentation's site: pages made from headers, schemas, the command line and the examples, and their build.

python -m tools.site            builds build/docs/site; a warning is an error
"""

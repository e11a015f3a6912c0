"""Asks a JSON Schema validator about graphs: validate.py REQUEST, where REQUEST is a file with
{"schema": {...}, "graphs": {"name": "text", ...}}. Prints {"name": null when the text is no JSON, or a list of errors}."""
import json
import sys

from jsonschema import Draft7Validator


def errors_of(validator, text):
    try:
        graph = json.loads(text)
    except ValueError:
        return None
    return [f"{error.json_path}: {error.message}"[:400] for error in validator.iter_errors(graph)]


with open(sys.argv[1], encoding="utf-8") as file:
    request = json.load(file)
Draft7Validator.check_schema(request["schema"])
schema = Draft7Validator(request["schema"])
print(json.dumps({name: errors_of(schema, text) for name, text in request["graphs"].items()}))

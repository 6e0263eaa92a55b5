"""What tests of JSON against a schema begin with."""
import json
import os
import shutil

import jsonschema


def opened(schema_path, folder):
    """The schema, which must be one itself, and its validator; from here on `folder`, emptied, is the working folder."""
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    os.chdir(folder)
    with open(schema_path) as file:
        schema = json.load(file)
    jsonschema.Draft202012Validator.check_schema(schema)
    return schema, jsonschema.Draft202012Validator(schema)

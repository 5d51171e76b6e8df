"""The official glTF validator, from npm, called on one file."""

import json
import os
import subprocess

SCRIPT = """
const fs = require('fs'), path = require('path');
const validator = require(path.join(process.argv[1], 'node_modules', 'gltf-validator'));
validator.validateBytes(new Uint8Array(fs.readFileSync(process.argv[2])), {maxIssues: 100})
    .then(report => console.log(JSON.stringify(report)), error => { console.error(error); process.exit(1); });
"""


def validate(npm_folder, path):
    """The validator's report as a dictionary; None where the validator is not installed."""
    if not os.path.isdir(os.path.join(npm_folder, "node_modules", "gltf-validator")):
        return None
    done = subprocess.run(["node", "-e", SCRIPT, os.path.abspath(npm_folder), os.path.abspath(path)],
                          stdout=subprocess.PIPE, check=True, timeout=120)
    return json.loads(done.stdout)

// Vectorizes one picture with vtracer, the whole way of a process: node vtracer.js NPM_FOLDER IN.png OUT.svg
const fs = require("fs");
const path = require("path");
const [folder, input, output] = process.argv.slice(2);
const { vectorizeSync, Preset } = require(path.join(path.resolve(folder), "node_modules", "@neplex", "vectorizer"));
fs.writeFileSync(output, vectorizeSync(fs.readFileSync(input), Preset.Bw));

// Prints errors, warnings and messages of glTF files by Khronos' validator, one JSON object a file.
// Exit code 3 where the validator isn't installed (npm install --prefix build gltf-validator).
const fs = require('fs'), path = require('path');
let validator;
try {
  validator = require(require.resolve('gltf-validator', {paths: [process.cwd(), process.cwd() + '/build']}));
} catch {
  process.exit(3);
}
(async () => {
  for (const file of process.argv.slice(2)) {
    const {issues} = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {
      externalResourceFunction: uri => fs.promises.readFile(path.resolve(path.dirname(file), decodeURIComponent(uri))).then(b => new Uint8Array(b))});
    // A texture coordinate no texture uses yet is what we mean to write. Of extensions that it doesn't know the
    // validator says so, and that what they alone use is unused.
    const unknown = issues.messages.some(m => m.code === 'UNSUPPORTED_EXTENSION');
    const expected = m => m.code === 'UNSUPPORTED_EXTENSION' ||
        m.code === 'UNUSED_OBJECT' && (/TEXCOORD_[01]$/.test(m.pointer) || unknown && /^\/(buffers|bufferViews|nodes|meshes|accessors)\/\d+$/.test(m.pointer));
    const messages = issues.messages.filter(m => !expected(m));
    console.log(JSON.stringify({errors: issues.numErrors, warnings: issues.numWarnings, messages}));
  }
})();

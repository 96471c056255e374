// Brings the scene of a report to life: three.js draws the meshes that are embedded in the page.
"use strict";

(function () {
  const data = Page.data.scene;
  const view = document.getElementById("view");
  if (!data || typeof THREE === "undefined")
    return;

  // --- Reading what is embedded --------------------------------------------------------------------------------------
  function bytesOf(letters) {
    const characters = atob(letters);
    const bytes = new Uint8Array(characters.length);
    for (let n = 0; n < bytes.length; ++n)
      bytes[n] = characters.charCodeAt(n);
    return bytes;
  }

  function wordsOf(letters, size) {
    const buffer = new DataView(bytesOf(letters).buffer);
    const words = size === 2 ? new Uint16Array(buffer.byteLength / 2) : new Uint32Array(buffer.byteLength / 4);
    for (let n = 0; n < words.length; ++n)
      words[n] = size === 2 ? buffer.getUint16(2 * n, true) : buffer.getUint32(4 * n, true);
    return words;
  }

  function geometryOf(mesh) {
    const steps = wordsOf(mesh.positions, 2);
    const positions = new Float32Array(steps.length);
    for (let n = 0; n < steps.length; ++n)
      positions[n] = mesh.min[n % 3] + mesh.size[n % 3] * steps[n] / 65535;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    geometry.setIndex(new THREE.BufferAttribute(wordsOf(mesh.indices, mesh.index_bytes), 1));
    geometry.computeVertexNormals();
    geometry.setAttribute("color", new THREE.BufferAttribute(new Uint8Array(steps.length), 3, true));
    return geometry;
  }

  // --- Colours --------------------------------------------------------------------------------------------------------
  const provenanceColours = [[190, 190, 190], [240, 150, 50], [80, 130, 220], [90, 180, 90]];
  const errorStops = [[62, 112, 200], [48, 168, 186], [118, 196, 104], [246, 214, 82], [238, 131, 48], [196, 30, 44]];
  const plain = [190, 192, 196];

  function between(stops, share) {
    const place = Math.min(share, 0.999999) * (stops.length - 1), below = Math.floor(place), part = place - below;
    return stops[below].map(function (value, n) { return value + part * (stops[below + 1][n] - value); });
  }

  // A function from the number of a vertex to its colour.
  function colouring(mesh, mode, instance) {
    const values = mesh[mode === "error" ? "error" : mode] ? bytesOf(mesh[mode]) : null;
    if (mode === "colours" && values)
      return function (v) { return [values[3 * v], values[3 * v + 1], values[3 * v + 2]]; };
    if (mode === "provenance" && values)
      return function (v) { return provenanceColours[values[v]] || plain; };
    if (mode === "confidence" && values)
      return function (v) { return between(errorStops, 1 - values[v] / 255); };
    if (mode === "error" && values)
      return function (v) { return between(errorStops, values[v] / 255); };
    const one = mode === "instance" ? instance : plain;
    return function () { return one; };
  }

  function paint(item, mode) {
    const colours = item.object.geometry.attributes.color;
    const colour = colouring(item.mesh, mode, item.colour);
    for (let v = 0; v < item.mesh.vertices; ++v)
      colours.array.set(colour(v), 3 * v);
    colours.needsUpdate = true;
  }

  // --- The scene ------------------------------------------------------------------------------------------------------
  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({antialias: true, alpha: true, preserveDrawingBuffer: true});
  } catch (error) {
    return; // the sentence stays
  }
  const scene = new THREE.Scene();
  const eye = new THREE.PerspectiveCamera(45, 1, 0.01, 200);
  eye.up.fromArray(data.up);
  const lamp = new THREE.DirectionalLight(0xffffff, 0.62);
  lamp.position.set(-0.3, 0.3, 1); // of the eye: from above on the left
  eye.add(lamp, lamp.target);
  scene.add(eye, new THREE.AmbientLight(0xffffff, 0.55));

  const items = [];  // meshes: {object, mesh, colour, shape}
  const movers = []; // what follows a trajectory: {node, poses}

  function addMesh(mesh, colour, shape, parent, side) {
    if (!mesh)
      return;
    const material = new THREE.MeshPhongMaterial({vertexColors: THREE.VertexColors, side: side, specular: 0x111111, shininess: 12});
    const object = new THREE.Mesh(geometryOf(mesh), material);
    parent.add(object);
    items.push({object: object, mesh: mesh, colour: colour, shape: shape});
  }

  function lineThrough(poses, colour) {
    const points = [];
    poses.forEach(function (pose) { if (pose) points.push(new THREE.Vector3(pose[0], pose[1], pose[2])); });
    const geometry = new THREE.BufferGeometry().setFromPoints(points);
    return new THREE.Line(geometry, new THREE.LineBasicMaterial({color: new THREE.Color().setRGB(colour[0] / 255, colour[1] / 255, colour[2] / 255)}));
  }

  function frustumOf(intrinsics, depth) {
    const c = intrinsics || {fx: 525, fy: 525, cx: 319.5, cy: 239.5, width: 640, height: 480};
    const corners = [[0, 0], [c.width, 0], [c.width, c.height], [0, c.height]].map(function (pixel) {
      return new THREE.Vector3((pixel[0] - c.cx) / c.fx * depth, (pixel[1] - c.cy) / c.fy * depth, depth);
    });
    const points = [];
    corners.forEach(function (corner, n) {
      points.push(new THREE.Vector3(), corner, corner, corners[(n + 1) % 4]);
    });
    return new THREE.LineSegments(new THREE.BufferGeometry().setFromPoints(points), new THREE.LineBasicMaterial({color: 0x78828c}));
  }

  const room = new THREE.Group(); // seen through from behind: walls do not hide what is before them
  addMesh(data.background, plain, "completed", room, THREE.FrontSide);
  scene.add(room);
  const groups = [];
  data.objects.forEach(function (object) {
    const group = new THREE.Group();
    addMesh(object.completed, object.colour, "completed", group, THREE.DoubleSide);
    addMesh(object.seen, object.colour, "seen", group, THREE.DoubleSide);
    const follower = new THREE.Group();
    follower.add(group);
    scene.add(follower);
    movers.push({node: follower, poses: object.poses});
    groups.push({name: object.name, id: object.id, node: group, colour: object.colour});
  });
  const paths = new THREE.Group();
  const distance = new THREE.Vector3().fromArray(data.eye).distanceTo(new THREE.Vector3().fromArray(data.target));
  if (data.camera) {
    paths.add(lineThrough(data.camera, [120, 130, 140]));
    const frustum = frustumOf(data.intrinsics, 0.08 * distance);
    paths.add(frustum);
    movers.push({node: frustum, poses: data.camera});
  }
  scene.add(paths);
  eye.near = Math.max(distance / 500, 1e-4);
  eye.far = distance * 100;

  // --- What the reader can do -----------------------------------------------------------------------------------------
  function make(name, attributes, parent, words) {
    const element = Page.make(name, attributes, words);
    if (parent)
      parent.append(element);
    return element;
  }

  const canvas = renderer.domElement;
  canvas.tabIndex = 0;
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", "The meshes of the run, to turn: drag, pinch, or click and use the wheel");
  const controls = new THREE.OrbitControls(eye, canvas);
  controls.enableKeys = false; // arrows scroll the page
  controls.enableZoom = false; // and so does the wheel, until the view is clicked
  canvas.addEventListener("focus", function () { controls.enableZoom = true; });
  canvas.addEventListener("blur", function () { controls.enableZoom = false; });
  canvas.addEventListener("mousedown", function () { canvas.focus({preventScroll: true}); });
  canvas.addEventListener("touchstart", function (event) { controls.enableZoom = event.touches.length > 1; }, {capture: true, passive: true});

  const rows = make("div", {}, null);
  const timeRow = make("div", {"class": "bar-row"}, rows);
  const play = make("button", {type: "button"}, timeRow, "Play");
  const slider = make("input", {type: "range", min: 0, max: data.stamps.length - 1, step: 1, value: 0, "aria-label": "Time"}, timeRow);
  const clock = make("output", {}, timeRow);
  const optionRow = make("div", {"class": "bar-row"}, rows);
  function choice(words, options) {
    const label = make("label", {}, optionRow, words + " ");
    const select = make("select", {}, label);
    options.forEach(function (option) { make("option", {value: option[0]}, select, option[1]); });
    return select;
  }
  function toggle(words, parent, checked, colour) {
    const label = make("label", {}, parent);
    const box = make("input", {type: "checkbox"}, label);
    box.checked = checked;
    if (colour)
      make("i", {"class": "key"}, label).style.background = "rgb(" + colour.join(",") + ")";
    label.append(words);
    return box;
  }
  const has = function (key) { return items.some(function (item) { return item.mesh[key]; }); };
  const modes = [["colours", "real"], ["provenance", "provenance"], ["confidence", "confidence"], ["instance", "object"], ["error", "error"]]
    .filter(function (mode) { return mode[0] === "instance" || has(mode[0]); });
  const mode = choice("Colour", modes);
  const shape = choice("Show", [["completed", "completed"], ["seen", "what was seen"]]);
  const follow = toggle("through the camera", optionRow, false);
  if (!data.camera)
    follow.parentNode.hidden = true;
  const reset = make("button", {type: "button"}, optionRow, "Reset view");
  const partRow = make("div", {"class": "bar-row"}, rows);
  const legend = make("ul", {"class": "legend"}, make("div", {"class": "bar-row"}, rows));

  let waiting = false;
  function draw() {
    renderer.render(scene, eye);
  }
  function drawSoon() {
    if (waiting)
      return;
    waiting = true;
    requestAnimationFrame(function () { waiting = false; draw(); });
  }

  function showPart(words, node, colour) {
    const box = toggle(words, partRow, true, colour);
    box.addEventListener("change", function () { node.visible = box.checked; drawSoon(); });
  }
  groups.forEach(function (group) { showPart(group.name, group.node, group.colour); });
  if (data.background)
    showPart("background", room);
  if (data.camera)
    showPart("camera", paths);

  function showLegend() {
    legend.textContent = "";
    const entry = function (className, words, colour) {
      const item = make("li", {}, legend);
      const key = make("i", {"class": className}, item);
      if (colour)
        key.style.background = "rgb(" + colour.join(",") + ")";
      item.append(words);
    };
    if (mode.value === "provenance")
      ["observed", "inferred by smoothness", "bounded by free space", "bounded by another body"]
        .forEach(function (words, n) { entry("key p" + n, words); });
    if (mode.value === "confidence")
      entry("scale turned", "confidence from 0 to 1, which is beside a reading");
    if (mode.value === "error")
      entry("scale", "0 to " + Number(data.error_max_mm.toPrecision(3)) + " mm and more");
    legend.parentNode.hidden = legend.childNodes.length === 0;
  }

  function showColours() {
    items.forEach(function (item) { paint(item, mode.value); });
    showLegend();
    drawSoon();
  }

  function showShape() {
    items.forEach(function (item) {
      item.object.visible = item.object.parent === room || item.shape === shape.value;
    });
    drawSoon();
  }

  function showTime() {
    const n = Number(slider.value);
    movers.forEach(function (mover) {
      const pose = mover.poses[n];
      mover.node.visible = Boolean(pose);
      if (!pose)
        return;
      mover.node.position.set(pose[0], pose[1], pose[2]);
      mover.node.quaternion.set(pose[3], pose[4], pose[5], pose[6]);
    });
    const stamp = data.stamps[n];
    clock.textContent = data.is_frame ? "frame " + stamp : (stamp - data.stamps[0]).toFixed(2) + " s";
    slider.setAttribute("aria-valuetext", clock.textContent);
    if (follow.checked && data.camera && data.camera[n])
      standAt(data.camera[n]);
    drawSoon();
  }

  // Look as the camera of the run does.
  function standAt(pose) {
    const rotation = new THREE.Quaternion(pose[3], pose[4], pose[5], pose[6]);
    const ahead = new THREE.Vector3(0, 0, 1).applyQuaternion(rotation);
    eye.position.set(pose[0], pose[1], pose[2]);
    controls.target.copy(eye.position).addScaledVector(ahead, distance);
    setAngle();
    controls.update();
  }

  // The vertical angle of view; wider where the view is narrow, so that the scene fits.
  function setAngle() {
    const camera = follow.checked ? data.intrinsics : null;
    const vertical = camera ? 0.5 * camera.height / camera.fy : Math.tan(Math.PI / 8);
    const horizontal = camera ? 0.5 * camera.width / camera.fx : 1.3 * vertical;
    eye.fov = 2 * Math.atan(Math.max(vertical, horizontal / eye.aspect)) * 180 / Math.PI;
    eye.updateProjectionMatrix();
  }

  function resetView() {
    follow.checked = false;
    eye.position.fromArray(data.eye);
    controls.target.fromArray(data.target);
    setAngle();
    controls.update();
    drawSoon();
  }

  let timer = 0;
  function stop() {
    clearInterval(timer);
    timer = 0;
    play.textContent = "Play";
  }
  play.addEventListener("click", function () {
    if (timer)
      return stop();
    play.textContent = "Pause";
    timer = setInterval(function () {
      slider.value = (Number(slider.value) + 1) % data.stamps.length;
      showTime();
    }, 60);
  });
  slider.addEventListener("input", function () { stop(); showTime(); });
  mode.addEventListener("change", showColours);
  shape.addEventListener("change", showShape);
  follow.addEventListener("change", function () { if (follow.checked) showTime(); else resetView(); });
  reset.addEventListener("click", resetView);
  controls.addEventListener("change", drawSoon);
  if (data.stamps.length < 2)
    timeRow.hidden = true;

  function fit() {
    const width = canvas.clientWidth, height = canvas.clientHeight;
    if (!width || !height)
      return;
    renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    renderer.setSize(width, height, false);
    eye.aspect = width / height;
    setAngle();
    draw();
  }

  // How many pixels show something; 0 where WebGL says that it works and does not.
  function drawnPixels() {
    const gl = renderer.getContext();
    const pixels = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
    gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let count = 0;
    for (let n = 3; n < pixels.length; n += 4)
      count += pixels[n] > 0 ? 1 : 0;
    return count;
  }

  // A link may say what to begin with: report.html#colour=provenance&show=seen&frame=40
  const wishes = new URLSearchParams(location.hash.slice(1));
  const wish = function (select, value) {
    if (value && Array.from(select.options).some(function (option) { return option.value === value; }))
      select.value = value;
  };
  wish(mode, wishes.get("colour"));
  wish(shape, wishes.get("show"));
  const frame = data.stamps.indexOf(Number(wishes.get("frame")));
  slider.value = wishes.has("frame") && frame >= 0 ? frame : Math.floor(data.stamps.length / 2);

  const sentence = document.getElementById("no-view");
  view.prepend(canvas);
  resetView();
  showColours();
  showShape();
  showTime();
  fit();
  view.dataset.pixels = drawnPixels();
  if (view.dataset.pixels === "0") {
    canvas.remove();
    return;
  }
  sentence.remove();
  view.append(rows);
  window.addEventListener("resize", fit);
})();

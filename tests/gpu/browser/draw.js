// Runs in the page: expands and draws one case by WebGPU, and reads the frame back from the GPU. Screenshots of a browser
// without a window are blank.

const read = async (path) => (await fetch(path)).arrayBuffer();
const text = async (path) => (await fetch(path)).text();

// Buffers by the bindings of decoder/shaders/README.md.
const storage = ["patches", "patch_instances", "instances", "domains", "positions"];

async function openDevice() {
  if (!navigator.gpu) throw new Error("no WebGPU: navigator.gpu is missing");
  const adapter = await navigator.gpu.requestAdapter();
  if (!adapter) throw new Error("no WebGPU: no adapter");
  const device = await adapter.requestDevice();
  const errors = [];
  device.addEventListener("uncapturederror", (event) => errors.push(event.error.message));
  return { device, errors, name: `${adapter.info?.vendor} ${adapter.info?.architecture}` };
}

async function makePipelines(device) {
  const module = async (name) => device.createShaderModule({ code: await text(`/shaders/${name}`) });
  const surface = await module("surface.wgsl");
  return {
    expand: device.createComputePipeline({ layout: "auto", compute: { module: await module("expand.wgsl") } }),
    draw: device.createRenderPipeline({
      layout: "auto",
      vertex: { module: surface },
      fragment: { module: surface, targets: [{ format: "rgba8unorm" }] },
      primitive: { topology: "triangle-list", frontFace: "ccw", cullMode: "none" },
      depthStencil: { format: "depth32float", depthWriteEnabled: true, depthCompare: "less" },
    }),
  };
}

// A patch is 8 bytes; the seventh tells which borders are finer.
function forgetBorders(patches) {
  const bytes = new Uint8Array(patches);
  for (let i = 6; i < bytes.length; i += 8) bytes[i] = 0;
  return patches;
}

async function loadCase(device, folder, shape, forgets) {
  const buffer = (bytes, usage) => {
    const made = device.createBuffer({ size: bytes.byteLength, usage: usage | GPUBufferUsage.COPY_DST });
    device.queue.writeBuffer(made, 0, bytes);
    return made;
  };
  const loaded = [buffer(await read(`${folder}/view`), GPUBufferUsage.UNIFORM)];
  for (const name of storage) {
    const bytes = await read(`${folder}/${name}`);
    loaded.push(buffer(forgets && name === "patches" ? forgetBorders(bytes) : bytes, GPUBufferUsage.STORAGE));
  }
  loaded.push(device.createBuffer({ size: 16 * shape.triangles, usage: GPUBufferUsage.STORAGE }));
  const command = new Uint32Array([0, 1, 0, 0, 0]);
  const usage = GPUBufferUsage.STORAGE | GPUBufferUsage.INDIRECT | GPUBufferUsage.COPY_SRC;
  loaded.push(buffer(command.buffer, usage));

  const size = [shape.map_width, shape.map_height];
  const map = device.createTexture({
    size,
    format: "rgba8snorm",
    usage: GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST,
  });
  const texels = await read(`${folder}/normal_map`);
  device.queue.writeTexture({ texture: map }, texels, { bytesPerRow: 4 * shape.map_width }, size);
  const sampler = device.createSampler({ magFilter: "linear", minFilter: "linear" });
  const resources = loaded.map((made) => ({ buffer: made }));
  return { command: loaded[7], resources: [...resources, map.createView(), sampler] };
}

function bind(device, pipeline, resources, bindings) {
  const entries = bindings.map((binding) => ({ binding, resource: resources[binding] }));
  return device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries });
}

function encode(device, pipelines, loaded, shape, targets) {
  const encoder = device.createCommandEncoder();
  const expand = encoder.beginComputePass();
  expand.setPipeline(pipelines.expand);
  expand.setBindGroup(0, bind(device, pipelines.expand, loaded.resources, [0, 1, 2, 3, 4, 5, 6, 7]));
  expand.dispatchWorkgroups(Math.min(shape.patches, 65535), Math.ceil(shape.patches / 65535));
  expand.end();
  const draw = encoder.beginRenderPass({
    colorAttachments: [
      { view: targets.colour.createView(), clearValue: [1, 0, 1, 1], loadOp: "clear", storeOp: "store" },
    ],
    depthStencilAttachment: {
      view: targets.depth.createView(),
      depthClearValue: 1,
      depthLoadOp: "clear",
      depthStoreOp: "discard",
    },
  });
  draw.setPipeline(pipelines.draw);
  draw.setBindGroup(0, bind(device, pipelines.draw, loaded.resources, [0, 3, 4, 5, 6, 8, 9]));
  draw.drawIndirect(loaded.command, 0);
  draw.end();
  encoder.copyTextureToBuffer({ texture: targets.colour }, { buffer: targets.pixels, bytesPerRow: 4 * shape.side }, [
    shape.side,
    shape.side,
  ]);
  encoder.copyBufferToBuffer(loaded.command, 0, targets.pixels, 4 * shape.side * shape.side, 20);
  device.queue.submit([encoder.finish()]);
}

const opened = openDevice();
const pipelines = opened.then(({ device }) => makePipelines(device));

// Returns the pixels in base64, top row first, and the five words of the command. forgets: as if no border was finer.
window.drawCase = async (name, forgets) => {
  const { device, errors, name: adapter } = await opened;
  const folder = `/cases/${name}`;
  const shape = JSON.parse(await text(`${folder}/case.json`));
  const size = [shape.side, shape.side];
  const texture = (format, usage) => device.createTexture({ size, format, usage: usage | GPUTextureUsage.RENDER_ATTACHMENT });
  const targets = {
    colour: texture("rgba8unorm", GPUTextureUsage.COPY_SRC),
    depth: texture("depth32float", 0),
    pixels: device.createBuffer({
      size: 4 * shape.side * shape.side + 20,
      usage: GPUBufferUsage.COPY_DST | GPUBufferUsage.MAP_READ,
    }),
  };
  encode(device, await pipelines, await loadCase(device, folder, shape, forgets), shape, targets);
  await targets.pixels.mapAsync(GPUMapMode.READ);
  const bytes = new Uint8Array(targets.pixels.getMappedRange());
  if (errors.length > 0) throw new Error(errors.join("\n"));
  const pixels = bytes.slice(0, -20);
  let binary = "";
  for (let i = 0; i < pixels.length; i += 4096) binary += String.fromCharCode(...pixels.subarray(i, i + 4096));
  const command = [...new Uint32Array(bytes.slice(-20).buffer)];
  return { adapter, pixels: btoa(binary), command };
};

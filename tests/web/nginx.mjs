// Debian's nginx on loopback, with a folder, a configuration and a port of its own.
import { spawn, spawnSync } from "node:child_process";
import { mkdirSync, writeFileSync } from "node:fs";
import { createServer } from "node:net";
import { join } from "node:path";

export const withoutNginx = spawnSync("nginx", ["-v"]).error ? "no nginx" : false;

const freePort = () =>
  new Promise((resolve) => {
    const server = createServer().listen(0, "127.0.0.1", () => {
      const { port } = server.address();
      server.close(() => resolve(port));
    });
  });

const configuration = (folder, port) => `
daemon off; master_process off; pid ${folder}/pid; error_log ${folder}/errors warn;
events { worker_connections 64; }
http {
  access_log off; default_type application/octet-stream; types { text/html html; text/javascript js; }
  client_body_temp_path ${folder}/tmp; proxy_temp_path ${folder}/tmp; fastcgi_temp_path ${folder}/tmp;
  uwsgi_temp_path ${folder}/tmp; scgi_temp_path ${folder}/tmp;
  server {
    listen 127.0.0.1:${port}; root ${folder}/files;
    location /ranges/ { alias ${folder}/files/; }
    location /no-ranges/ { alias ${folder}/files/; max_ranges 0; }
    location /gzip/ { alias ${folder}/files/; gzip on; gzip_min_length 1; gzip_types application/octet-stream; }
  }
}`;

// Serves FOLDER/files at /ranges/, /no-ranges/ and /gzip/. Returns the address and stop().
export async function startNginx(folder) {
  const port = await freePort();
  mkdirSync(join(folder, "files"), { recursive: true });
  writeFileSync(join(folder, "conf"), configuration(folder, port));
  const server = spawn("nginx", ["-p", folder, "-c", join(folder, "conf"), "-e", join(folder, "errors")], { stdio: "inherit" });
  const address = `http://127.0.0.1:${port}`;
  for (let tries = 0; ; ++tries) {
    try {
      await fetch(`${address}/ranges/nothing`);
      break;
    } catch (error) {
      if (tries === 100) throw error;
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
  }
  return { address, stop: () => new Promise((resolve) => (server.on("exit", resolve), server.kill())) };
}

import { defineConfig } from 'vite';
import { viteSingleFile } from 'vite-plugin-singlefile';

// One HTML file with everything inside; its place for the result stays as written in index.html.
export default defineConfig({
  base: './',
  plugins: [viteSingleFile({ removeViteModuleLoader: true })],
  build: { target: 'es2022', emptyOutDir: false, chunkSizeWarningLimit: 2000, modulePreload: false },
});

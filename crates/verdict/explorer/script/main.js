// Starts the interactive part of the page in place of fixed pictures. If it fails, these stay.

import { Container } from './data/container.js';
import { readPageModel } from './data/page_model.js';
import { DrivePanel } from './drive/panel.js';
import { Explorer } from './explorer.js';
import { PageData } from './data/page_data.js';

function startExplorer() {
  const root = document.getElementById('explorer');
  try {
    const model = readPageModel();
    if (!root || !model || typeof DecompressionStream === 'undefined') {
      return;
    }
    if (model.kind === 'drive') {
      root.hidden = false;
      new DrivePanel(root, new PageData(model, Container.ofDocument()));
      return;
    }
    if (model.sensors.length === 0) {
      return;
    }
    const explorer = new Explorer(model, Container.ofDocument(), root);
    root.hidden = false;
    document.querySelectorAll('.static-maps').forEach((maps) => maps.classList.add('x-replaced'));
    explorer.start().catch((error) => {
      console.error(error);
      explorer.listWords.textContent = `The rays could not be read: ${String(error)}.`;
    });
  } catch (error) {
    console.error(error);
    if (root) {
      root.hidden = true;
    }
    document.querySelectorAll('.static-maps').forEach((maps) => maps.classList.remove('x-replaced'));
  }
}

startExplorer();

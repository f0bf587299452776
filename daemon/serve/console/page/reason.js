// SPDX-License-Identifier: Apache-2.0
// Asks a person for the reason of a step that is kept with it.
import { by } from "./elements.js";

/** The reason, or null where the person thinks better of it. `action`: what the button says. */
export function askReason(title, text, action) {
  const dialog = by("reason"), why = by("reason-why");
  by("reason-title").textContent = title;
  by("reason-text").textContent = text;
  by("reason-act").textContent = action;
  why.value = "";
  return new Promise((resolve) => {
    by("reason-form").onsubmit = (event) => {
      event.preventDefault();
      if (why.value.trim()) dialog.close(why.value.trim());
    };
    by("reason-cancel").onclick = () => dialog.close("");
    dialog.oncancel = () => { dialog.returnValue = ""; };  // the escape key
    dialog.onclose = () => resolve(dialog.returnValue || null);
    dialog.returnValue = "";
    dialog.showModal();
    why.focus();
  });
}

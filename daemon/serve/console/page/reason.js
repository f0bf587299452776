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
    // Not by the event "close": it comes later than the next question may.
    const end = (reason) => { dialog.close(); resolve(reason); };
    by("reason-form").onsubmit = (event) => {
      event.preventDefault();
      if (why.value.trim()) end(why.value.trim());
    };
    by("reason-cancel").onclick = () => end(null);
    dialog.oncancel = (event) => { event.preventDefault(); end(null); };  // the escape key
    dialog.showModal();
    why.focus();
  });
}

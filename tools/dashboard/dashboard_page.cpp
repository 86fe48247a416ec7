// SPDX-License-Identifier: Apache-2.0
#include "dashboard_page.hpp"

namespace fdcg::tools {

const char* const kDashboardPage = R"html(<!doctype html>
<html lang="en"><meta charset="utf-8"><title>fdcg-servo</title>
<style>
  body { font: 16px/1.4 system-ui, sans-serif; margin: 1.5rem auto; max-width: 50rem; padding: 0 1rem; }
  button { font: inherit; padding: .4rem 1rem; margin-right: .5rem; }
  table { border-collapse: collapse; width: 100%; margin-top: 1rem; }
  th, td { text-align: left; padding: .3rem .6rem; border-bottom: 1px solid #8885; font-variant-numeric: tabular-nums; }
  meter { width: 8rem; }
  #said { white-space: pre-wrap; color: #555; }
  :root { color-scheme: light dark; }
</style>
<h1>fdcg-servo</h1>
<p><button data-command="disarm">Disarm (space)</button><button data-command="arm">Arm</button>
<button data-command="record">Record</button><button data-command="pause">Pause recording</button>
<span id="link" role="status">connecting</span></p>
<table><thead><tr><th>device<th>gate<th>fault<th>contact<th>force (N)<th>energy (mJ)</tr></thead><tbody id="devices"></tbody></table>
<p id="said" role="log"></p>
<script>
const socket = new WebSocket(`ws://${location.host}/`), link = document.getElementById("link");
const send = (command) => socket.readyState === 1 && socket.send(command);
for (const button of document.querySelectorAll("button")) button.onclick = () => send(button.dataset.command);
addEventListener("keydown", (event) => { if (event.key === " ") { event.preventDefault(); send("disarm"); } });
socket.onopen = () => { link.textContent = "connected"; };
socket.onclose = () => { link.textContent = "the run has ended"; };
socket.onmessage = (message) => {
  const told = JSON.parse(message.data);
  if (told.event === "said") document.getElementById("said").prepend(told.text + "\n");
  if (told.event !== "snapshot") return;
  const rows = told.devices.map((device) => {
    const row = document.createElement("tr"), force = Math.hypot(...device.force_n);
    const touch = device.contacts.map((contact) => contact.object === null ? "free" : `${contact.state} of ${contact.object}`);
    for (const text of [device.name, device.phase, device.fault, touch.join(", "), force.toFixed(2), (1000 * device.given_j).toFixed(2)])
      row.insertCell().textContent = text;
    return row;
  });
  document.getElementById("devices").replaceChildren(...rows);
};
</script></html>
)html";

}  // namespace fdcg::tools

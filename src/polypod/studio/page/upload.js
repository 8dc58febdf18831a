// Files sent to the studio, with progress. By XMLHttpRequest, for `fetch` tells nothing of how far
// an upload is.

// The answer; throws the server's own word, with what it wants beside the file as `wants`. `bar` is
// a progress element, hidden while nothing is sent.
export async function sendFile(store, route, file, bar) {
  bar.hidden = false;
  bar.value = 0;
  try {
    return await post(store, route, file, bar);
  } finally {
    bar.hidden = true;
  }
}

function post(store, route, file, bar) {
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    request.open("POST", `${route}?name=${encodeURIComponent(file.name)}`);
    request.setRequestHeader("X-Polypod-Token", store.token);
    request.setRequestHeader("Content-Type", "application/octet-stream");
    request.responseType = "json";
    request.upload.onprogress = (event) => {
      // All sent: the server reads it, for which there is no measure.
      if (event.loaded < event.total) bar.value = event.loaded / event.total;
      else bar.removeAttribute("value");
    };
    request.onload = () => {
      if (request.status === 200) resolve(request.response);
      else reject(refusal(request));
    };
    request.onerror = () => reject(new Error("the studio does not answer"));
    request.send(file);
  });
}

function refusal({ response, status, statusText }) {
  const error = new Error(response?.why ?? `${status} ${statusText}`);
  error.wants = response?.wants ?? [];
  return error;
}

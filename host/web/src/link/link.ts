// SPDX-License-Identifier: Apache-2.0
// link.ts - the fragment of the link that tact-view prints: "#token=0123" and, for pictures, "&sharp".

/** The token, null if there is none, and the fragment without it. */
export function split_link(hash: string): { token: string | null; rest: string } {
  const parts = hash.replace(/^#/, "").split("&");
  const token = parts.find((part) => part.startsWith("token="))?.slice("token=".length) ?? null;
  const rest = parts.filter((part) => part !== "" && !part.startsWith("token=")).join("&");
  return { token, rest: rest && `#${rest}` };
}

/** Takes the token out of the address bar: no bookmark, history or screenshot keeps it. */
export function take_token(): string | null {
  const { token, rest } = split_link(location.hash);
  if (token !== null) history.replaceState(null, "", location.pathname + location.search + rest);
  return token;
}

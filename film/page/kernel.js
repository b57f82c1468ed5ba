"use strict";
// The kernel in the page: where there is one, a reader changes the input of a step and goes on from there.
const Inside = { offer: () => {} };
